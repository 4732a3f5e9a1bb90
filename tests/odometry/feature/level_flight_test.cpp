// Short level flights over flat ground: the initialisation, and what the estimator reports in
// addition to its pose.
#include <gtest/gtest.h>

#include <functional>
#include <opencv2/imgproc.hpp>

#include "core/time.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "odometry/geometry/lie.hpp"
#include "tests/odometry/synthetic_flight.hpp"
#include "tests/odometry/test_frame.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::SyntheticFlightOptions;
using testing::SyntheticGround;

/// A short level flight at 40 m/s, 200 m above flat ground, with debug output.
struct LevelFlight {
  std::vector<VoEstimate> estimates;
  std::vector<Pose> T_world_camera;
};

/// @param tilt_rad  of the camera, forward or back from nadir
LevelFlight fly_level(VoPort& odometry, double duration_s, double tilt_rad = 0.0) {
  SyntheticFlightOptions options;
  options.speed_m_s = 40.0;
  options.height_m = 200.0;
  options.straight_s = 10.0;
  options.duration_s = duration_s;
  const SyntheticGround ground = SyntheticGround::procedural(1, 512, 1.0, 0.0);
  const auto camera =
      PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  odometry.set_debug(true);
  LevelFlight flight;
  flight.T_world_camera = testing::fly_s_turns(options);
  for (std::size_t i = 0; i < flight.T_world_camera.size(); ++i) {
    Pose& T_world_camera = flight.T_world_camera[i];
    T_world_camera.rotation = T_world_camera.rotation * exp_so3({tilt_rad, 0.0, 0.0});
    const VoFrame frame =
        testing::test_frame(i, camera, ground.render(camera, T_world_camera, 1.0, i + 1));
    flight.estimates.push_back(odometry.track(frame).value());
  }
  return flight;
}

std::vector<VoEstimate> fly_level(const FeatureParameters& parameters, double duration_s) {
  return fly_level(*create_feature_odometry(parameters).value(), duration_s).estimates;
}

/// The frames of a level flight, each changed, and what the estimator made of them.
std::vector<VoEstimate> fly_changed(const FeatureParameters& parameters,
                                    const std::function<void(Image&)>& change) {
  class Changing final : public VoPort {
   public:
    Changing(std::unique_ptr<VoPort> inner, const std::function<void(Image&)>& change)
        : inner_(std::move(inner)), change_(change) {}
    [[nodiscard]] std::string type() const override { return inner_->type(); }
    [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
      return inner_->effective_parameters();
    }
    [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override {
      Image image = *frame.image;
      change_(image);
      VoFrame changed = frame;
      changed.image = std::make_shared<const Image>(std::move(image));
      return inner_->track(changed);
    }
    void set_debug(bool wanted) override { inner_->set_debug(wanted); }

   private:
    std::unique_ptr<VoPort> inner_;
    const std::function<void(Image&)>& change_;
  };
  Changing port(create_feature_odometry(parameters).value(), change);
  return fly_level(port, 1.6).estimates;
}

/// First frame with a pose; the number of frames when there is none.
std::size_t first_tracked(const std::vector<VoEstimate>& estimates) {
  std::size_t i = 0;
  while (i < estimates.size() && estimates[i].sample.state != TrackingState::kTracking) ++i;
  return i;
}

TEST(FeatureOdometry, AKnownHeightMakesItsUnitsMetres) {
  FeatureParameters parameters;
  parameters.initial_height_m = 200.0;
  const auto estimates = fly_level(parameters, 1.2);
  const std::size_t first = first_tracked(estimates);
  ASSERT_LT(first + 6, estimates.size());
  const EstimateSample& begin = estimates[first].sample;
  const EstimateSample& last = estimates.back().sample;
  EXPECT_NEAR(last.scene_depth.value(), 200.0, 1.0);
  const double flown_s = static_cast<double>(last.t_ns - begin.t_ns) * 1e-9;
  const Eigen::Vector3d way = last.T_vo_camera.translation - begin.T_vo_camera.translation;
  EXPECT_NEAR(way.norm(), 40.0 * flown_s, 0.01 * 40.0 * flown_s + 0.1);
  EXPECT_NEAR(estimates.back().map_points_vo.front().z(), 200.0F, 4.0F);
}

TEST(FeatureOdometry, StartsOverAPlaneSeenObliquely) {
  // Two views of a plane allow two motions there; the wrong one turns the camera.
  for (const double tilt_deg : {-40.0, 40.0}) {
    const auto odometry = create_feature_odometry({}).value();
    const LevelFlight flight = fly_level(*odometry, 2.5, rad_from_deg(tilt_deg));
    const std::size_t first = first_tracked(flight.estimates);
    ASSERT_LT(first, 60U) << tilt_deg;
    for (std::size_t i = first; i < flight.estimates.size(); ++i) {
      const EstimateSample& sample = flight.estimates[i].sample;
      ASSERT_EQ(sample.state, TrackingState::kTracking) << i;
      const Pose truth = flight.T_world_camera[first].inverse() * flight.T_world_camera[i];
      const Pose estimate =
          flight.estimates[first].sample.T_vo_camera.inverse() * sample.T_vo_camera;
      EXPECT_LT(rotation_angle_rad(truth.rotation, estimate.rotation), rad_from_deg(0.3)) << i;
      if (truth.translation.norm() < 5.0) continue;
      EXPECT_GT(truth.translation.normalized().dot(estimate.translation.normalized()), 0.999) << i;
    }
  }
}

TEST(FeatureOdometry, StartsSoonerOverAPlaneWhenItConsidersOne) {
  const auto first = [](bool planar_start) {
    FeatureParameters parameters;
    parameters.planar_start = planar_start;
    const auto odometry = create_feature_odometry(parameters).value();
    return first_tracked(fly_level(*odometry, 2.0, rad_from_deg(20.0)).estimates);
  };
  EXPECT_LT(first(true) + 12, first(false));  // 15 and 39
}

TEST(FeatureOdometry, HoldsMorePointsOfBlurredGroundWhenItMindsLowTexture) {
  const auto blur = [](Image& image) {
    cv::Mat view(image.height_px, image.width_px, CV_8U, image.data.data());
    cv::GaussianBlur(view, view, {}, 4.0);
  };
  const auto held = [&](bool low_texture) {
    FeatureParameters parameters;
    parameters.low_texture = low_texture;
    return fly_changed(parameters, blur).back().counters.at("inliers");
  };
  EXPECT_GT(held(true), 2.0 * held(false));  // 403 and 115
}

TEST(FeatureOdometry, TintsBurntAreasWhenItRejectsThem) {
  const auto burn = [](Image& image) {
    for (int y = 0; y < image.height_px; ++y) {
      for (int x = 0; x < image.width_px / 3; ++x) image.at(x, y) = 255;
    }
  };
  FeatureParameters parameters;
  const auto tinted = [&] {
    const Image view = *fly_changed(parameters, burn).back().debug_image;
    const std::uint8_t* pixel =
        &view.data[3U * (20U * static_cast<std::size_t>(view.width_px) + 20U)];
    return pixel[1] < pixel[0];  // magenta
  };
  EXPECT_TRUE(tinted());
  parameters.reject_saturated = false;
  EXPECT_FALSE(tinted());
}

TEST(FeatureOdometry, TracksWhileAThreadBesideItMaps) {
  FeatureParameters parameters;
  parameters.threads = 2;
  const auto estimates = fly_level(parameters, 2.0);
  // However late the thread is, the first map stays in view over these 40 m.
  int tracked = 0;
  for (const VoEstimate& estimate : estimates) {
    EXPECT_NE(estimate.sample.state, TrackingState::kLost) << estimate.sample.frame;
    tracked += estimate.sample.state == TrackingState::kTracking ? 1 : 0;
  }
  EXPECT_GT(tracked, 30);
  EXPECT_EQ(estimates.back().sample.map_id, 0);
  EXPECT_NEAR(estimates.back().sample.scene_depth.value(), 1.0, 0.01);
}

TEST(FeatureOdometry, ReportsUnitDepthAndStages) {
  const auto estimates = fly_level({}, 1.2);
  const VoEstimate* last = &estimates.back();
  ASSERT_EQ(last->sample.state, TrackingState::kTracking);
  // Flat ground from level flight: every pose sees the depth that the first keyframe had, 1.
  EXPECT_NEAR(last->sample.scene_depth.value(), 1.0, 0.01);
  EXPECT_EQ(last->map_points_vo.size(), static_cast<std::size_t>(last->counters.at("inliers")));
  EXPECT_EQ(last->debug_image->width_px, 320);  // as the image: it is too small to be halved
  EXPECT_EQ(last->debug_image->channels, 3);
  for (const char* stage : {"total", "pyramid", "tracking"}) {
    EXPECT_TRUE(last->timing_ms.contains(stage)) << stage;
  }
  EXPECT_GT(last->counters.at("keyframes"), 1.0);
  // Two and more images of 320 x 240 with their smaller levels.
  EXPECT_GT(last->counters.at("map_memory_mb"), 0.2);
  EXPECT_LT(last->counters.at("map_memory_mb"), 50.0);
  // In 1e6 bytes: a whole number of bytes.
  const double bytes = 1e6 * last->counters.at("map_memory_mb");
  EXPECT_NEAR(bytes, std::round(bytes), 1e-3);
}

TEST(FeatureOdometry, AccountsForItsThreadsAndItsMap) {
  for (const int threads : {1, 2}) {
    FeatureParameters parameters;
    parameters.threads = threads;
    const auto estimator = create_feature_odometry(parameters).value();
    ASSERT_TRUE(estimator->resource_use());
    EXPECT_FALSE(estimator->resource_use()->own_process);
    EXPECT_EQ(estimator->resource_use()->cpu_s, 0.0);
    (void)fly_level(*estimator, 1.2);
    const ResourceUse use = *estimator->resource_use();
    EXPECT_GT(use.cpu_s, 0.05);
    EXPECT_GT(use.peak_memory_mb, 0.2);
  }
}

}  // namespace
}  // namespace overfly::odometry::feature
