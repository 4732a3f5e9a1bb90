// Truth images against closed forms: flat ground, a ramp, a step that hides what lies behind it.
#include "renderer/camera/truth_images.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderer/camera/row_projector.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

constexpr float kSky = std::numeric_limits<float>::infinity();

PinholeCamera small_pinhole() {
  return PinholeCamera::from_fov(160, 120, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

CameraModel bent_camera() {
  return {small_pinhole(), {DistortionModel::kRadtan, {-0.2, 0.05, 1e-3, -1e-3, 0.0}}};
}

Pose pose_of(const RollPitchYaw& attitude, const Eigen::Vector3d& p_world) {
  return {R_world_body_from(attitude) * R_body_camera_nadir(), p_world};
}

/// Ground up = slope * east, as a height query and as a plane to cut rays with.
class Ramp final : public HeightQuery {
 public:
  explicit Ramp(double slope) : slope_(slope) {}
  [[nodiscard]] double ground_up_m(double east_m, double /*north_m*/) const override {
    return slope_ * east_m;
  }
  /// Depth image of a request by cutting each ray with the plane.
  [[nodiscard]] DepthImage depth(const PixelRays& rays, const CameraRequest& request) const {
    const PinholeCamera& camera = request.camera.pinhole();
    DepthImage image(camera.width_px, camera.height_px, 1, kSky);
    const Eigen::Vector3d plane(-slope_, 0.0, 1.0);
    for (int y = 0; y < camera.height_px; ++y) {
      const Pose pose = request.T_world_camera.at(request.row_time_ns(y));
      for (int x = 0; x < camera.width_px; ++x) {
        const Eigen::Vector3d ray = pose.rotation * rays.at(x, y);
        const double z_m = -plane.dot(pose.translation) / plane.dot(ray);
        if (std::isfinite(z_m) && z_m > 0.0) image.at(x, y) = static_cast<float>(z_m);
      }
    }
    return image;
  }

 private:
  double slope_;
};

CameraRequest rolling_request(const CameraModel& camera,
                              std::int64_t t_ns,
                              std::int64_t readout_ns) {
  // 65 deg/s of roll, 30 deg/s of yaw, 25 m/s; linear between poses 1 ms apart.
  std::vector<StampedPose> poses;
  for (std::int64_t at_ns = t_ns - 40'000'000; at_ns <= t_ns + 40'000'000; at_ns += 1'000'000) {
    const double t_s = static_cast<double>(at_ns - 1000000000) * 1e-9;
    poses.push_back({at_ns,
                     pose_of({0.2 + rad_from_deg(65.0) * t_s, 0.05, rad_from_deg(30.0) * t_s},
                             {25.0 * t_s, 3.0 * t_s, 300.0})});
  }
  CameraRequest request;
  request.camera = camera;
  request.T_world_camera = CameraMotion::from_poses(poses).value();
  request.t_ns = t_ns;
  request.readout_ns = readout_ns;
  return request;
}

TEST(RangeImage, IsHeightOverCosineAboveFlatGround) {
  const CameraRequest request =
      CameraRequest::still(small_pinhole(), pose_of({}, {0, 0, 300}), 0, PixelFormat::kGrey8);
  const PixelRays rays(request.camera);
  DepthImage depth = Ramp(0.0).depth(rays, request);
  depth.at(3, 4) = kSky;
  const DepthImage range = range_image(rays, depth);
  for (const auto& [x, y] : {std::pair{0, 0}, {159, 0}, {80, 60}, {12, 100}}) {
    const double tangent =
        std::hypot((x - 79.5) / small_pinhole().fx_px, (y - 59.5) / small_pinhole().fy_px);
    EXPECT_NEAR(range.at(x, y), 300.0 / std::cos(std::atan(tangent)), 1e-3);
  }
  EXPECT_EQ(range.at(3, 4), kSky);
}

TEST(WorldPoints, LieOnTheRampThroughLensAndRollingShutter) {
  const Ramp ramp(0.2);
  for (const CameraModel& camera : {CameraModel(small_pinhole()), bent_camera()}) {
    for (const std::int64_t readout_ns : {std::int64_t{0}, std::int64_t{30'000'000}}) {
      const CameraRequest request = rolling_request(camera, 1'000'000'000, readout_ns);
      const PixelRays rays(camera);
      DepthImage depth = ramp.depth(rays, request);
      depth.at(7, 8) = kSky;
      const PointImage points = world_points(rays, request, depth);
      const RowProjector projector(request);
      EXPECT_TRUE(std::isnan(points.at(7, 8, 0)));
      for (int y = 0; y < 120; y += 7) {
        for (int x = 0; x < 160; x += 11) {
          const Eigen::Vector3d p(points.at(x, y, 0), points.at(x, y, 1), points.at(x, y, 2));
          // A float's depth of 300 to 900 m is good to 6e-5 m, longer along the ray.
          EXPECT_NEAR(p.z(), 0.2 * p.x(), 2e-4);
          const auto again = projector.project(p);
          ASSERT_TRUE(again.has_value());
          EXPECT_LT((again->pixel - Eigen::Vector2d(x, y)).norm(), 1e-4);
          EXPECT_NEAR(again->depth_m, depth.at(x, y), 1e-3);
        }
      }
    }
  }
}

TEST(SurfaceNormals, AreThoseOfTheRampInBothFrames) {
  const Ramp ramp(0.2);
  const CameraRequest request = CameraRequest::still(
      small_pinhole(), pose_of({0.3, 0.1, 0.4}, {0, 0, 300}), 0, PixelFormat::kGrey8);
  const PixelRays rays(request.camera);
  DepthImage depth = ramp.depth(rays, request);
  depth.at(1, 1) = kSky;
  const PointImage points = world_points(rays, request, depth);
  const VectorImage in_world = surface_normals(points, ramp, request, NormalFrame::kWorld);
  const VectorImage in_camera = surface_normals(points, ramp, request, NormalFrame::kCamera);
  const Eigen::Vector3d wanted = Eigen::Vector3d(-0.2, 0.0, 1.0).normalized();
  const Eigen::Vector3d seen = request.T_world_camera.at(0).rotation.conjugate() * wanted;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(in_world.at(50, 40, i), wanted(i), 1e-6);
    EXPECT_NEAR(in_camera.at(50, 40, i), seen(i), 1e-6);
    EXPECT_TRUE(std::isnan(in_world.at(1, 1, i)));
  }
  // Seen from above, the ground's normal points towards the camera.
  EXPECT_LT(in_camera.at(50, 40, 2), 0.0F);
}

TEST(OpticalFlow, IsSpeedTimesFocalLengthOverHeightAboveFlatGround) {
  const PinholeCamera camera = small_pinhole();
  // Nose north, 3 m north and 1 m east between the images: the ground moves down and left.
  const auto first = CameraRequest::still(camera, pose_of({}, {0, 0, 300}), 0, PixelFormat::kGrey8);
  const auto next = CameraRequest::still(camera, pose_of({}, {1, 3, 300}), 1, PixelFormat::kGrey8);
  const PixelRays rays(first.camera);
  const Ramp flat(0.0);
  const PointImage points = world_points(rays, first, flat.depth(rays, first));
  const VectorImage flow = optical_flow(points, next, flat.depth(rays, next));
  EXPECT_NEAR(flow.at(80, 60, 0), -camera.fx_px * 1.0 / 300.0, 1e-4);
  EXPECT_NEAR(flow.at(80, 60, 1), camera.fy_px * 3.0 / 300.0, 1e-4);
  // The bottom row leaves the image.
  EXPECT_TRUE(std::isnan(flow.at(80, 119, 1)));
  EXPECT_FALSE(std::isnan(flow.at(80, 117, 1)));
}

TEST(OpticalFlow, SolvesForTheRowThatSeesThePoint) {
  const Ramp ramp(0.1);
  const CameraModel camera = bent_camera();
  const CameraRequest first = rolling_request(camera, 1'000'000'000, 30'000'000);
  const CameraRequest next = rolling_request(camera, 1'020'000'000, 30'000'000);
  const PixelRays rays(camera);
  const PointImage points = world_points(rays, first, ramp.depth(rays, first));
  const VectorImage flow = optical_flow(points, next, ramp.depth(rays, next));
  int checked = 0;
  for (int y = 10; y < 110; y += 9) {
    for (int x = 10; x < 150; x += 9) {
      if (std::isnan(flow.at(x, y, 0))) continue;
      const Eigen::Vector2d there(x + flow.at(x, y, 0), y + flow.at(x, y, 1));
      // At the time of the row it claims, the point projects to the pixel it claims.
      const Pose pose = next.T_world_camera.at(next.row_time_ns(there.y()));
      const Eigen::Vector3d p(points.at(x, y, 0), points.at(x, y, 1), points.at(x, y, 2));
      const auto pixel = camera.project(pose.inverse() * p);
      ASSERT_TRUE(pixel.has_value());
      EXPECT_LT((*pixel - there).norm(), 1e-4);
      ++checked;
    }
  }
  EXPECT_GT(checked, 50);
}

TEST(OpticalFlow, IsInvalidWhereNearerGroundHidesThePoint) {
  const PinholeCamera camera = small_pinhole();
  const auto first = CameraRequest::still(camera, pose_of({}, {0, 0, 300}), 0, PixelFormat::kGrey8);
  const PixelRays rays(first.camera);
  const Ramp flat(0.0);
  const DepthImage depth = flat.depth(rays, first);
  const PointImage points = world_points(rays, first, depth);
  DepthImage hidden = depth;
  for (int y = 20; y < 40; ++y) {
    for (int x = 20; x < 40; ++x) hidden.at(x, y) = 250.0F;
  }
  const VectorImage flow = optical_flow(points, first, hidden);
  EXPECT_TRUE(std::isnan(flow.at(30, 30, 0)));
  EXPECT_NEAR(flow.at(60, 30, 0), 0.0F, 1e-4F);
}

TEST(ValidityMask, TellsImageryFromBareGroundFromSky) {
  const auto ground = overfly::testing::natural_ground();  // 2 x 2 km about the origin
  const auto request =
      CameraRequest::still(small_pinhole(), pose_of({}, {1000, 0, 300}), 0, PixelFormat::kGrey8);
  const PixelRays rays(request.camera);
  DepthImage depth = Ramp(0.0).depth(rays, request);
  depth.at(0, 0) = kSky;
  const Image mask = validity_mask(world_points(rays, request, depth), *ground);
  EXPECT_EQ(mask.at(0, 0), kMaskNothing);
  EXPECT_EQ(mask.at(10, 60), kMaskImagery);  // west of the edge
  EXPECT_EQ(mask.at(150, 60), kMaskVoid);    // east of it
}

}  // namespace
}  // namespace overfly::renderer
