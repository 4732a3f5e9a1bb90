// Motion of the image during an exposure against closed forms and against more pixels.
#include "renderer/camera/image_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace overfly::renderer {
namespace {

constexpr double kMotionFocalPx = 200.0;
const FlatGround kFlat(10.0);

/// A centred camera with a pixel in its middle.
CameraModel odd_camera() {
  return PinholeCamera{321, 241, kMotionFocalPx, kMotionFocalPx, 160.0, 120.0};
}

Pose pose_over_flat(const RollPitchYaw& attitude, const Eigen::Vector3d& p) {
  return {R_world_body_from(attitude) * R_body_camera_nadir(), p};
}

/// A request of 20 ms around 50 ms whose camera moves linearly from the first to the last pose.
CameraRequest exposed_request(const Pose& from, const Pose& to) {
  CameraRequest request;
  request.camera = odd_camera();
  request.T_world_camera = CameraMotion::from_poses({{40'000'000, from}, {60'000'000, to}}).value();
  request.t_ns = 50'000'000;
  request.exposure_ns = 20'000'000;
  return request;
}

TEST(ImageMotion, OfLevelFlightIsFocalLengthTimesWayOverHeight) {
  const Pose before = pose_over_flat({}, {0.0, 0.0, 110.0});
  const Pose after = pose_over_flat({}, {3.0, -4.0, 110.0});
  EXPECT_NEAR(
      largest_motion_px(odd_camera(), before, after, kFlat), kMotionFocalPx * 5.0 / 100.0, 1e-9);
}

TEST(ImageMotion, OfATurnAboutTheAxisIsTheCornersChord) {
  const Pose before = pose_over_flat({}, {0.0, 0.0, 110.0});
  const Pose after = pose_over_flat({0.0, 0.0, 0.06}, {0.0, 0.0, 110.0});
  const double corner_px = std::hypot(160.0, 120.0);
  EXPECT_NEAR(largest_motion_px(odd_camera(), before, after, kFlat),
              2.0 * corner_px * std::sin(0.03),
              1e-9);
}

TEST(ImageMotion, IsThatOfThePixelsThatMoveMost) {
  const CameraModel camera(odd_camera().pinhole(),
                           {DistortionModel::kRadtan, {-0.2, 0.05, 1e-3, 0.0, 0.0}});
  const Pose before = pose_over_flat({0.6, 0.2, 1.0}, {5.0, 6.0, 90.0});
  const Pose after = pose_over_flat({0.62, 0.19, 1.03}, {6.0, 5.0, 91.0});
  double dense_px = 0.0;
  for (int y = 0; y < 241; y += 4) {
    for (int x = 0; x < 321; x += 4) {
      const Eigen::Vector3d ray = before.rotation * *camera.ray({x, y});
      const double depth_m = ray.z() < 0.0 ? 80.0 / -ray.z() : 1e7;
      const auto moved = camera.project(after.inverse() * (before.translation + depth_m * ray));
      if (moved) dense_px = std::max(dense_px, (*moved - Eigen::Vector2d(x, y)).norm());
    }
  }
  const double found_px = largest_motion_px(camera, before, after, kFlat);
  EXPECT_LE(found_px, dense_px + 1e-3);
  EXPECT_GE(found_px, 0.98 * dense_px);
}

/// Of an exposure during which the image moves by 2 px per metre.
std::vector<ExposureInstant> instants_of(double way_m) {
  return exposure_instants(exposed_request(pose_over_flat({}, {0.0, 0.0, 110.0}),
                                           pose_over_flat({}, {way_m, 0.0, 110.0})),
                           kFlat);
}

TEST(ExposureInstants, AreOnePerPixelOfTheStreakAndOneMore) {
  EXPECT_EQ(instants_of(0.12).size(), 1U);
  EXPECT_EQ(instants_of(0.13).size(), 2U);
  EXPECT_EQ(instants_of(2.4).size(), 6U);    // 4.8 px
  EXPECT_EQ(instants_of(10.2).size(), 22U);  // 20.4 px
  EXPECT_EQ(instants_of(100.0).size(), std::size_t{kMaxInstants});
  CameraRequest still =
      exposed_request(pose_over_flat({}, {0.0, 0.0, 110.0}), pose_over_flat({}, {9.0, 0.0, 110.0}));
  still.exposure_ns = 0;
  EXPECT_EQ(exposure_instants(still, kFlat).size(), 1U);
}

/// Light that varies over the image as a cosine, of which the mean over a streak is a sinc.
TEST(ExposureInstants, GiveTheMeanOfLightThatVaries) {
  struct Limit {
    double period_px, error;
  };
  for (const Limit& limit : {Limit{8.0, 0.002}, Limit{4.0, 0.007}, Limit{2.0, 0.027}}) {
    for (double streak_px = 0.06; streak_px < 127.0; streak_px *= 1.03) {
      double mean = 0.0;
      double weight = 0.0;
      for (const ExposureInstant& instant : instants_of(0.5 * streak_px)) {
        const double at_px = streak_px * static_cast<double>(instant.offset_ns) / 20e6;
        mean += double{instant.weight} * std::cos(2.0 * kPi * at_px / limit.period_px);
        weight += double{instant.weight};
      }
      const double half = kPi * streak_px / limit.period_px;
      EXPECT_NEAR(mean, std::sin(half) / half, limit.error) << limit.period_px << ", " << streak_px;
      EXPECT_NEAR(weight, 1.0, 1e-6);
    }
  }
}

TEST(ExposureInstants, CountAVibrationThatReturns) {
  // To and fro by 1.01 m, four times: no displacement at the end, 16.16 px of streak.
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 8; ++i) {
    const double east_m = i % 2 == 0 ? 0.0 : 1.01;
    poses.push_back({40'000'000 + 2'500'000LL * i, pose_over_flat({}, {east_m, 0.0, 110.0})});
  }
  CameraRequest request = exposed_request(poses.front().pose, poses.back().pose);
  request.T_world_camera = CameraMotion::from_poses(poses).value();
  EXPECT_EQ(exposure_instants(request, kFlat).size(), 18U);
}

TEST(ExposureInstants, AreTheMostForStreaksOfAnyLength) {
  // A quarter turn between two instants takes the axis almost parallel to the image plane: its
  // pixel moves by 1e14 px.
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 8; ++i) {
    poses.push_back({40'000'000 + 2'500'000LL * i,
                     pose_over_flat({i * (0.5 * kPi - 1e-12), 0.0, 0.0}, {0.0, 0.0, 110.0})});
  }
  CameraRequest request = exposed_request(poses.front().pose, poses.back().pose);
  request.T_world_camera = CameraMotion::from_poses(poses).value();
  EXPECT_EQ(exposure_instants(request, kFlat).size(), std::size_t{kMaxInstants});
}

/// A request of 20 ms whose camera moves to the east by `east_m(t_s)`, t from the middle, with
/// poses `raster_ns` apart.
template <typename East>
CameraRequest eastward_request(const East& east_m, std::int64_t raster_ns) {
  std::vector<StampedPose> poses;
  for (std::int64_t t_ns = -10'000'000; t_ns <= 10'000'000; t_ns += raster_ns) {
    const double t_s = 1e-9 * static_cast<double>(t_ns);
    poses.push_back({50'000'000 + t_ns, pose_over_flat({}, {east_m(t_s), 0.0, 110.0})});
  }
  CameraRequest request = exposed_request(poses.front().pose, poses.back().pose);
  request.T_world_camera = CameraMotion::from_poses(poses).value();
  return request;
}

/// 8 periods in 20 ms: the even pieces of an exposure begin and end at the same place.
double shaken_east_m(double t_s) { return std::sin(2.0 * kPi * 400.0 * t_s); }

TEST(ExposureInstants, CountAVibrationThatIsFasterThanThePieces) {
  // 4 m and 8 px a period, of which ten poses miss up to 5 %.
  const std::size_t instants =
      exposure_instants(eastward_request(shaken_east_m, 250'000), kFlat).size();
  EXPECT_GE(instants, 61U + 1U);
  EXPECT_LE(instants, 64U + 1U);
}

TEST(ExposureInstants, AreTheSameForSmoothMotionHoweverManyPoses) {
  // Turns back in the middle of a piece, which that piece does not see: 19.9 instead of 20.2 px.
  const auto east_m = [](double t_s) { return 49750.0 * (t_s - 1.25e-3) * (t_s - 1.25e-3); };
  for (const std::int64_t raster_ns : {2'500'000, 1'250'000, 100'000}) {
    const auto instants = exposure_instants(eastward_request(east_m, raster_ns), kFlat);
    EXPECT_EQ(instants.size(), 20U + 1U) << raster_ns;
  }
}

TEST(RowsOfOnePose, FollowAVibrationThatIsFasterThanThePieces) {
  const auto rows = [](double amplitude_m) {
    CameraRequest request =
        eastward_request([&](double t_s) { return amplitude_m * shaken_east_m(t_s); }, 250'000);
    request.exposure_ns = 0;
    request.readout_ns = 20'000'000;
    return rows_of_one_pose(request, kFlat);
  };
  // Sixteen pieces are half periods, which begin and end at zero. Fastest between the pose at zero
  // and the next one, 36 deg later: in 250 us, the time of three rows.
  const double px_per_row = 2.0 * 0.01 * std::sin(kPi / 5.0) / 3.0;
  EXPECT_EQ(rows(0.01), static_cast<int>(0.1 / px_per_row));
  EXPECT_EQ(rows(1.0), 1);
}

TEST(RowsOfOnePose, MoveLessThanATwentiethOfAPixel) {
  const auto rows = [](double way_m, std::int64_t readout_ns) {
    CameraRequest request = exposed_request(pose_over_flat({}, {0.0, 0.0, 110.0}),
                                            pose_over_flat({}, {way_m, 0.0, 110.0}));
    request.readout_ns = readout_ns;
    return rows_of_one_pose(request, kFlat);
  };
  EXPECT_EQ(rows(5.0, 0), 241);
  EXPECT_EQ(rows(0.0, 20'000'000), 241);
  // 2 px per metre over 240 row steps: 0.1 px take 12 / way rows.
  EXPECT_EQ(rows(0.98, 20'000'000), 12);
  EXPECT_EQ(rows(5.0, 20'000'000), 2);
  EXPECT_EQ(rows(5.0, 10'000'000), 4);
  EXPECT_EQ(rows(500.0, 20'000'000), 1);
  EXPECT_EQ(rows(0.049, 20'000'000), 241) << "the whole image moves by less than 0.1 px";
}

}  // namespace
}  // namespace overfly::renderer
