// Video that does not look straight down on land: forward driving, and particles in front of the
// lens.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <random>

#include "odometry/feature/feature_odometry.hpp"
#include "tests/odometry/street_scene.hpp"
#include "tests/odometry/synthetic_flight.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::DriveOptions;
using testing::Street;
using testing::SyntheticFlightOptions;
using testing::SyntheticGround;

struct Video {
  std::vector<Pose> truth;  ///< T_world_camera
  std::vector<EstimateSample> samples;
  double rate_hz = 0.0;
};

using Draw = std::function<Image(std::size_t frame, const Pose& T_world_camera)>;

Video track(std::vector<Pose> truth,
            double rate_hz,
            const PinholeCamera& camera,
            const Draw& draw) {
  const auto odometry = create_feature_odometry({}).value();
  Video video{std::move(truth), {}, rate_hz};
  for (std::size_t i = 0; i < video.truth.size(); ++i) {
    VoFrame frame;
    frame.index = static_cast<std::int64_t>(i);
    frame.t_ns = static_cast<std::int64_t>(static_cast<double>(i) / rate_hz * 1e9);
    frame.intrinsics = camera;
    frame.image = std::make_shared<const Image>(draw(i, video.truth[i]));
    video.samples.push_back(odometry->track(frame).value().sample);
  }
  return video;
}

struct Judgement {
  double start_s = 1e9;
  double tracked_share = 0.0;  ///< of the frames since the start, in the first map
  double path_m = 0.0;
  double rmse_m = 0.0;  ///< after the best similarity
};

Judgement judge(const Video& video) {
  Judgement judgement;
  std::vector<Eigen::Vector3d> estimates;
  std::vector<Eigen::Vector3d> true_places;
  std::size_t first = 0;
  for (std::size_t i = 0; i < video.samples.size(); ++i) {
    const EstimateSample& sample = video.samples[i];
    if (sample.state != TrackingState::kTracking || sample.map_id != 0) continue;
    if (estimates.empty()) first = i;
    estimates.push_back(sample.T_vo_camera.translation);
    true_places.push_back(video.truth[i].translation);
  }
  if (estimates.size() < 4) return judgement;
  judgement.start_s = static_cast<double>(first) / video.rate_hz;
  judgement.tracked_share =
      static_cast<double>(estimates.size()) / static_cast<double>(video.samples.size() - first);
  const auto count = static_cast<Eigen::Index>(estimates.size());
  Eigen::Matrix3Xd from(3, count);
  Eigen::Matrix3Xd to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = estimates[static_cast<std::size_t>(i)];
    to.col(i) = true_places[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix4d S = Eigen::umeyama(from, to);
  const Eigen::Matrix3Xd errors =
      (S.topLeftCorner<3, 3>() * from).colwise() + Eigen::Vector3d(S.topRightCorner<3, 1>()) - to;
  judgement.rmse_m = std::sqrt(errors.squaredNorm() / static_cast<double>(count));
  judgement.path_m = (true_places.back() - true_places.front()).norm();
  return judgement;
}

TEST(OtherVideo, ForwardDrivingStartsAndIsTracked) {
  const Street street(3);
  const PinholeCamera camera = testing::street_camera();
  const DriveOptions options;
  const Judgement judgement = judge(
      track(testing::drive(options), options.rate_hz, camera, [&](std::size_t i, const Pose& T) {
        return street.render(camera, T, 2.0, i + 1);
      }));
  EXPECT_LE(judgement.start_s, 1.5);
  EXPECT_GE(judgement.tracked_share, 0.95);
  EXPECT_LT(judgement.rmse_m, 0.01 * judgement.path_m);
  EXPECT_GT(judgement.path_m, 25.0);
}

/// Forty discs of 4 to 17 px, light or dark.
void paint_specks(Image& image, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  const auto below = [&](int limit) {
    return static_cast<int>(rng() % static_cast<std::uint64_t>(limit));
  };
  for (int speck = 0; speck < 40; ++speck) {
    const Eigen::Vector2d centre(below(image.width_px), below(image.height_px));
    const double radius_px = 0.5 * (4 + below(14));
    const std::uint8_t grey = below(2) == 0 ? 10 : 245;
    const auto reach = static_cast<int>(radius_px);
    const int left = std::max(0, static_cast<int>(centre.x()) - reach);
    const int right = std::min(image.width_px - 1, static_cast<int>(centre.x()) + reach);
    const int top = std::max(0, static_cast<int>(centre.y()) - reach);
    const int bottom = std::min(image.height_px - 1, static_cast<int>(centre.y()) + reach);
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        if ((Eigen::Vector2d(x, y) - centre).squaredNorm() < radius_px * radius_px) {
          image.at(x, y) = grey;
        }
      }
    }
  }
}

class OtherVideoWithSpecks : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Moving, OtherVideoWithSpecks, ::testing::Values(false, true));

TEST_P(OtherVideoWithSpecks, StartsAndIsTracked) {
  const SyntheticGround ground = SyntheticGround::procedural(1, 1024, 0.8, 15.0);
  const auto camera =
      PinholeCamera::from_fov(640, 480, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  SyntheticFlightOptions options;
  options.straight_s = 2.0;
  options.duration_s = 4.0;
  const Judgement judgement = judge(track(
      testing::fly_s_turns(options), options.rate_hz, camera, [&](std::size_t i, const Pose& T) {
        Image image = ground.render(camera, T, 1.5, i + 1);
        paint_specks(image, GetParam() ? i + 1 : 1);
        return image;
      }));
  EXPECT_LE(judgement.start_s, 1.5);
  EXPECT_GE(judgement.tracked_share, 0.95);
  EXPECT_LT(judgement.rmse_m, 0.1);
}

}  // namespace
}  // namespace overfly::odometry::feature
