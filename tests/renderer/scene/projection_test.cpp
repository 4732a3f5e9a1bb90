// A camera's image on the ground of a scene view: each pixel must lie where the camera sees it.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "renderer/ground/ground_ray.hpp"
#include "renderer/renderer.hpp"
#include "renderer/viewpoint.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::ProceduralGround;

const PinholeCamera kPinhole{640, 480, 400.0, 400.0, 319.5, 239.5};

/// A nadir camera, image top to the north, then rolled to the right and pitched.
Pose tilted_camera(const Eigen::Vector3d& place, double roll_rad = 0.0, double pitch_rad = 0.0) {
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  const Eigen::AngleAxisd roll(roll_rad, Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd pitch(pitch_rad, Eigen::Vector3d::UnitX());
  return {Eigen::Quaterniond(roll * pitch * R_world_camera), place};
}

/// Black with a soft bright dot.
std::shared_ptr<const Image> dot_at(const Eigen::Vector2d& pixel) {
  auto image = std::make_shared<Image>(kPinhole.width_px, kPinhole.height_px, 1);
  for (int y = 0; y < image->height_px; ++y) {
    for (int x = 0; x < image->width_px; ++x) {
      const double r2 = (Eigen::Vector2d(x, y) - pixel).squaredNorm();
      image->at(x, y) = static_cast<std::uint8_t>(std::lround(255.0 * std::exp(-r2 / 32.0)));
    }
  }
  return image;
}

class Projection : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
  }

  void use(const std::function<double(double, double)>& height_m,
           const Eigen::Vector2d& height_range_m) {
    ProceduralGround::Options options;
    options.height_m = height_m;
    options.height_range_m = height_range_m;
    options.paint = [](double, double) { return 30.0; };
    options.curved = false;
    ground_ = std::make_shared<ProceduralGround>(options);
    renderer_ = std::move(create_egl_renderer(ground_).value());
  }

  /// An image taken while the camera moved evenly from one pose to another.
  SceneContent::Projection taken(std::shared_ptr<const Image> image,
                                 const CameraModel& camera,
                                 const Pose& first,
                                 const Pose& last) {
    const auto caster = create_raycast_renderer(ground_);
    const Pose middle = interpolate(first, last, 0.5);
    auto depth = caster->render_depth(camera, middle);
    EXPECT_TRUE(depth.ok());
    return {std::move(image),
            camera,
            first,
            last,
            std::make_shared<const DepthImage>(std::move(*depth))};
  }

  Image draw(const std::optional<SceneContent::Projection>& projection, const Pose& T_world_view) {
    SceneContent content;
    content.projection = projection;
    SceneView view;
    view.T_world_camera = T_world_view;
    auto image = renderer_->render_scene(view, content);
    EXPECT_TRUE(image.ok());
    return std::move(*image);
  }

  /// Pixel of a scene view of the usual size.
  static Eigen::Vector2d in_view(const Pose& T_world_view, const Eigen::Vector3d& p_world) {
    const SceneView view;
    const auto camera =
        PinholeCamera::from_fov(view.width_px, view.height_px, view.fov_y_rad, FovAxis::kVertical);
    return camera->project(T_world_view.inverse() * p_world).value();
  }

  /// The point of the ground that a pixel sees.
  [[nodiscard]] Eigen::Vector3d seen_ground(const CameraModel& camera,
                                            const Pose& pose,
                                            const Eigen::Vector2d& pixel) const {
    const Eigen::Vector3d ray = pose.rotation * camera.ray(pixel).value();
    const auto hit = cast_to_ground(*ground_, pose.translation, ray.normalized(), 5000.0);
    const double depth_m = (hit.value() - pose.translation).norm() / ray.norm();
    return pose.translation + refine_depth(*ground_, pose.translation, ray, depth_m) * ray;
  }

  /// Centre of what the projection brightens.
  Eigen::Vector2d bright_spot(const SceneContent::Projection& projection,
                              const Pose& T_world_view) {
    const Image image = draw(projection, T_world_view);
    const Image plain = draw(std::nullopt, T_world_view);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weight = 0.0;
    for (int y = 0; y < image.height_px; ++y) {
      for (int x = 0; x < image.width_px; ++x) {
        const double w = std::max(0, image.at(x, y, 1) - plain.at(x, y, 1) - 60);
        sum += w * Eigen::Vector2d(x, y);
        weight += w;
      }
    }
    EXPECT_GT(weight, 0.0);
    return sum / weight;
  }

  std::shared_ptr<const ProceduralGround> ground_;
  std::unique_ptr<Renderer> renderer_;
};

TEST_F(Projection, LaysPixelsWhereTheCameraSeesThemThroughEveryLens) {
  use(overfly::testing::hills_m, {-45.0, 45.0});
  const Pose pose = tilted_camera({20.0, -30.0, 240.0}, 0.35, -0.2);
  const Pose view = look_at({260.0, -330.0, 330.0}, {20.0, -30.0, 0.0}, {0, 0, 1});
  const CameraModel models[] = {
      CameraModel(kPinhole),
      CameraModel(kPinhole, {DistortionModel::kRadtan, {-0.28, 0.07, 2e-4, 2e-5, 0.0}}),
      CameraModel(kPinhole, {DistortionModel::kEquidistant, {-0.01, 0.002, 0.0, 0.0, 0.0}}),
      CameraModel(kPinhole, {DistortionModel::kFov, {0.9, 0.0, 0.0, 0.0, 0.0}}),
      CameraModel(kPinhole, {DistortionModel::kFov, {}})};
  for (const CameraModel& camera : models) {
    SCOPED_TRACE(to_string(camera.distortion().model));
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(319.5, 239.5), Eigen::Vector2d(120.0, 90.0), Eigen::Vector2d(520, 400)}) {
      const Eigen::Vector2d spot = bright_spot(taken(dot_at(pixel), camera, pose, pose), view);
      const Eigen::Vector2d expected = in_view(view, seen_ground(camera, pose, pixel));
      EXPECT_LT((spot - expected).norm(), 0.8)
          << spot.transpose() << " instead of " << expected.transpose();
    }
  }
}

TEST_F(Projection, FollowsTheRowsOfARollingShutter) {
  use([](double, double) { return 0.0; }, {0.0, 0.0});
  const CameraModel camera(kPinhole);
  const Pose first = tilted_camera({-5.0, 0.0, 200.0}, -0.01);
  const Pose last = tilted_camera({5.0, 0.0, 200.0}, 0.01);
  const Pose view = top_viewpoint({0.0, 0.0, 0.0}, 0.0, 400.0);
  for (const double row : {20.0, 239.5, 455.0}) {
    const Eigen::Vector2d pixel(300.0, row);
    const Eigen::Vector2d spot = bright_spot(taken(dot_at(pixel), camera, first, last), view);
    const Pose then = interpolate(first, last, row / 479.0);
    const Eigen::Vector2d expected = in_view(view, seen_ground(camera, then, pixel));
    EXPECT_LT((spot - expected).norm(), 0.5) << row;
  }
}

TEST_F(Projection, LeavesGroundAloneThatTheCameraDoesNotSee) {
  // A ridge of 60 m from 100 to 140 m east of the camera, which looks over it from 80 m.
  use([](double east_m,
         double) { return 60.0 * std::max(0.0, 1.0 - std::abs(east_m - 120.0) / 20.0); },
      {0.0, 60.0});
  Eigen::Matrix3d R_world_camera;  // to the east, 25 deg down
  const double down_rad = rad_from_deg(25.0);
  R_world_camera.col(0) = Eigen::Vector3d(0, -1, 0);
  R_world_camera.col(2) = Eigen::Vector3d(std::cos(down_rad), 0, -std::sin(down_rad));
  R_world_camera.col(1) = R_world_camera.col(2).cross(R_world_camera.col(0));
  const Pose pose{Eigen::Quaterniond(R_world_camera), {0.0, 0.0, 80.0}};
  const CameraModel camera(kPinhole);
  const auto white = std::make_shared<const Image>(kPinhole.width_px, kPinhole.height_px, 1, 255);
  const Pose view = top_viewpoint({120.0, 0.0, 0.0}, 0.0, 500.0);
  const Image scene = draw(taken(white, camera, pose, pose), view);
  const auto brightness = [&](double east_m, double up_m) {
    const Eigen::Vector2d at = in_view(view, {east_m, 0.0, up_m});
    return scene.at(
        static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())), 1);
  };
  EXPECT_GT(brightness(90.0, 0.0), 200) << "before the ridge";
  EXPECT_GT(brightness(112.0, 36.0), 200) << "on its near side";
  EXPECT_LT(brightness(150.0, 0.0), 100) << "behind it";
  EXPECT_LT(brightness(250.0, 0.0), 100) << "far behind it, still in its shadow";
  EXPECT_LT(brightness(-10.0, 0.0), 100) << "behind the camera";
}

TEST_F(Projection, KeepsTheColoursOfAColourImage) {
  use([](double, double) { return 0.0; }, {0.0, 0.0});
  auto blue = std::make_shared<Image>(kPinhole.width_px, kPinhole.height_px, 3);
  for (std::size_t i = 2; i < blue->data.size(); i += 3) blue->data[i] = 250;
  const Pose pose = tilted_camera({0.0, 0.0, 150.0});
  const Image scene = draw(taken(blue, CameraModel(kPinhole), pose, pose),
                           top_viewpoint({0.0, 0.0, 0.0}, 0.0, 300.0));
  EXPECT_GT(scene.at(480, 360, 2), 200);
  EXPECT_LT(scene.at(480, 360, 0), 60);
}

}  // namespace
}  // namespace overfly::renderer
