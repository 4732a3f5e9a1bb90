#include "vo_bridges/lcm/lcm_estimator.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "core/measure/crc32.hpp"
#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"

namespace overfly {
namespace {

using ::testing::Contains;
using testing::fly;
using ::testing::HasSubstr;
using testing::impatient;
using ::testing::IsEmpty;
using testing::LcmBehaviour;
using testing::LcmPair;
using testing::make_memq_pair;
using ::testing::Pair;
using testing::varied_frames;

TEST(LcmEstimator, TellsCameraLensAndParameters) {
  LcmEstimatorOptions options;
  options.parameters = {{"nFeatures", 1000.0}, {"loop", false}, {"vocabulary", std::string("a b")}};
  const LcmPair pair = make_memq_pair({}, options);
  VoFrame frame = varied_frames(1).front();
  frame.camera_id = "belly";
  frame.distortion = {DistortionModel::kFov, {0.9, 0.0, 0.0, 0.0, 0.0}};
  ASSERT_TRUE(pair.door->track(frame).ok());
  const auto calibration = pair.far_end->calibration();
  ASSERT_TRUE(calibration.has_value());
  EXPECT_EQ(calibration->camera, "belly");
  EXPECT_EQ(calibration->width, 64);
  EXPECT_EQ(calibration->height, 48);
  EXPECT_EQ(calibration->fx, frame.intrinsics.fx_px);
  EXPECT_EQ(calibration->cy, frame.intrinsics.cy_px);
  EXPECT_EQ(calibration->distortion_model, "fov");
  EXPECT_EQ(calibration->distortion[0], 0.9);
  EXPECT_EQ(calibration->lockstep, 1);
  ASSERT_EQ(calibration->parameters.size(), 3U);
  EXPECT_EQ(calibration->parameters[0].name, "loop");
  EXPECT_EQ(calibration->parameters[0].value, "false");
  EXPECT_EQ(calibration->parameters[1].value, "1000");
}

TEST(LcmEstimator, SendsImagesByteForByteAndReturnsTheHashOfTheOtherEnd) {
  const LcmPair pair = make_memq_pair();
  const std::vector<VoFrame> frames = varied_frames(3, 33, 17);
  for (VoFrame frame : frames) {
    frame.exposure_ns = 2'000'000;
    const auto estimate = pair.door->track(frame);
    ASSERT_TRUE(estimate.ok());
    EXPECT_EQ(estimate->image_crc32, crc32_of(*frame.image));
  }
  const auto images = pair.far_end->images();
  ASSERT_EQ(images.size(), 3U);
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_EQ(images[i].data, frames[i].image->data);
    EXPECT_EQ(images[i].crc32, crc32_of(*frames[i].image));
    EXPECT_EQ(images[i].frame, frames[i].index);
    EXPECT_EQ(images[i].t_ns, frames[i].t_ns);
    EXPECT_EQ(images[i].utime, frames[i].t_ns / 1000);
    EXPECT_EQ(images[i].exposure_ns, 2'000'000);
    EXPECT_EQ(images[i].sequence, static_cast<std::int64_t>(i) + 1);
    EXPECT_EQ(images[i].row_stride, 33);
  }
}

TEST(LcmEstimator, SamplesOfSensorsComeBeforeTheirImageAndOnce) {
  // The second image is lost twice and sent again; its samples are not.
  int losses = 0;
  LcmBehaviour behaviour;
  behaviour.loses_image = [&](const overfly_lcm::image_t& image) {
    return image.frame == 1 && ++losses <= 2;
  };
  const LcmPair pair = make_memq_pair(behaviour);
  std::vector<VoFrame> frames = varied_frames(3);
  frames[1].sensors.imu = {{10'000'000, {0.5, -0.25, -9.75}, {0.125, 0.25, -0.5}},
                           {15'000'000, {1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}};
  frames[2].sensors.imu = {{35'000'000, {}, {}}};
  GpsSample fix;
  fix.t_ns = 1'000'000;
  fix.delivered_ns = 30'000'000;
  fix.place = geodetic_from_deg(39.5, -86.0, 210.5);
  fix.velocity_ned_m_s = {20.0, -3.0, 0.5};
  fix.vertical_accuracy_m = 9.25;
  frames[1].sensors.gps = {fix};
  for (const VoFrame& frame : frames) ASSERT_TRUE(pair.door->track(frame).ok());
  EXPECT_EQ(losses, 3);

  const auto imu = pair.far_end->imu();
  ASSERT_EQ(imu.size(), 3U);
  EXPECT_EQ(imu[0].t_ns, 10'000'000);
  EXPECT_EQ(imu[0].utime, 10'000);
  EXPECT_EQ(imu[0].session, pair.far_end->calibration()->session);
  EXPECT_THAT(imu[0].specific_force, ::testing::ElementsAre(0.5, -0.25, -9.75));
  EXPECT_THAT(imu[0].angular_rate, ::testing::ElementsAre(0.125, 0.25, -0.5));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(imu[i].sequence, static_cast<std::int64_t>(i) + 1);
  }
  const auto gps = pair.far_end->gps();
  ASSERT_EQ(gps.size(), 1U);
  EXPECT_EQ(gps[0].t_ns, 1'000'000);
  EXPECT_EQ(gps[0].delivered_ns, 30'000'000);
  EXPECT_EQ(gps[0].fix, 3);
  EXPECT_NEAR(gps[0].lat_deg, 39.5, 1e-12);
  EXPECT_EQ(gps[0].alt_ellipsoid, 210.5);
  EXPECT_THAT(gps[0].velocity_ned, ::testing::ElementsAre(20.0, -3.0, 0.5));
  EXPECT_EQ(gps[0].vertical_accuracy, 9.25);
}

TEST(LcmEstimator, ReturnsPoseDepthCountersAndTimings) {
  const LcmPair pair = make_memq_pair();
  const std::vector<VoEstimate> estimates = fly(*pair.door, 3);
  EXPECT_EQ(estimates[0].sample.state, TrackingState::kInitialising);
  const VoEstimate& last = estimates[2];
  EXPECT_EQ(last.sample.state, TrackingState::kTracking);
  EXPECT_EQ(last.sample.T_vo_camera.translation, Eigen::Vector3d(0.0, 0.0, 2.0));
  // The first byte of the third image is 10: 10/256 rad about the optical axis.
  EXPECT_NEAR(last.sample.T_vo_camera.rotation.z(), std::sin(10.0 / 512.0), 1e-15);
  EXPECT_EQ(last.sample.scene_depth, 12.5);
  EXPECT_EQ(last.counters, (std::map<std::string, double>{{"features", 64.0}}));
  EXPECT_EQ(last.timing_ms, (std::map<std::string, double>{{"tracking", 1.5}}));
}

TEST(LcmEstimator, PassesOnWhatTheStatusSays) {
  const LcmPair pair = make_memq_pair();
  EXPECT_THAT(pair.door->effective_parameters(), IsEmpty());
  EXPECT_FALSE(pair.door->resource_use().has_value());
  fly(*pair.door, 1);
  EXPECT_EQ(
      pair.door->effective_parameters(),
      (std::map<std::string, std::string>{{"estimator", "counting 2.1"}, {"nFeatures", "1000"}}));
  ASSERT_TRUE(pair.door->resource_use().has_value());
  EXPECT_EQ(pair.door->resource_use()->cpu_s, 1.25);
  EXPECT_EQ(pair.door->resource_use()->peak_memory_mb, 20.0);
  EXPECT_THAT(pair.door->take_log(), Contains("ready"));
  EXPECT_THAT(pair.door->take_log(), IsEmpty());
}

TEST(LcmEstimator, WaitsForAnEstimatorThatStartsLate) {
  LcmBehaviour behaviour;
  behaviour.calibrations_missed = 1;
  LcmEstimatorOptions options;
  const LcmPair pair = make_memq_pair(behaviour, options);
  const auto estimates = fly(*pair.door, 2);
  EXPECT_EQ(estimates[1].sample.state, TrackingState::kTracking);
  EXPECT_EQ(pair.far_end->images().size(), 2U) << "none was sent before it was there";
}

TEST(LcmEstimator, FailsForGoodWhenNobodyIsThere) {
  LcmBehaviour behaviour;
  behaviour.calibrations_missed = 1000;
  const LcmPair pair = make_memq_pair(behaviour, impatient());
  const auto frames = varied_frames(2);
  for (const VoFrame& frame : frames) {
    const auto estimate = pair.door->track(frame);
    ASSERT_FALSE(estimate.ok());
    EXPECT_EQ(estimate.error().code, ErrorCode::kInternal);
    EXPECT_THAT(estimate.error().message, HasSubstr("OVERFLY_CALIBRATION"));
    EXPECT_THAT(estimate.error().message, HasSubstr("memq://"));
  }
}

TEST(LcmEstimator, FliesOnInRealTimeUntilTheStartTimeoutWhenNobodyIsThere) {
  LcmBehaviour behaviour;
  behaviour.calibrations_missed = 1000;
  const LcmPair pair = make_memq_pair(behaviour, impatient(false));
  const auto frames = varied_frames(100);
  const auto first = pair.door->track(frames[0]);
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(first->sample.state, TrackingState::kInitialising);
  EXPECT_THAT(first->counters, Contains(Pair("unanswered", 1.0)));
  EXPECT_THAT(pair.door->take_log(), Contains(HasSubstr("waits for an estimator that answers")));
  std::size_t i = 1;
  while (i < frames.size() && pair.door->track(frames[i]).ok()) ++i;
  EXPECT_LT(i, frames.size());
}

VoFrame without_image(VoFrame frame) {
  frame.image.reset();
  return frame;
}

TEST(LcmEstimator, IsPreparedBeforeTheFirstFrame) {
  const LcmPair pair = make_memq_pair({}, impatient(false));
  const auto frames = varied_frames(2);
  ASSERT_TRUE(pair.door->prepare(without_image(frames[0])).ok());
  EXPECT_THAT(pair.door->effective_parameters(), Contains(Pair("nFeatures", "1000")));
  EXPECT_EQ(pair.far_end->calibration()->fx, frames[0].intrinsics.fx_px);
  EXPECT_THAT(pair.far_end->images(), IsEmpty());
  for (const VoFrame& frame : frames) {
    const auto estimate = pair.door->track(frame);
    ASSERT_TRUE(estimate.ok());
    EXPECT_FALSE(estimate->counters.contains("unanswered"));
  }
  EXPECT_EQ(pair.far_end->sessions(), 1) << "track begins no other";
}

TEST(LcmEstimator, LosesNoFrameInRealTimeToALateStartWhenPrepared) {
  LcmBehaviour behaviour;
  behaviour.calibrations_missed = 3;
  LcmEstimatorOptions options;
  options.lockstep = false;
  options.answer_timeout_s = 0.2;  // less than it takes to be there
  const LcmPair pair = make_memq_pair(behaviour, options);
  ASSERT_TRUE(pair.door->prepare(without_image(varied_frames(1).front())).ok());
  EXPECT_EQ(pair.far_end->sessions(), 1);
}

TEST(LcmEstimator, IsGoneForGoodWhenNobodyIsThereToBePrepared) {
  LcmBehaviour behaviour;
  behaviour.calibrations_missed = 1000;
  const LcmPair pair = make_memq_pair(behaviour, impatient(false));
  const VoFrame frame = varied_frames(1).front();
  const Status prepared = pair.door->prepare(without_image(frame));
  ASSERT_FALSE(prepared.ok());
  EXPECT_EQ(prepared.error().code, ErrorCode::kInternal);
  EXPECT_THAT(prepared.error().message, HasSubstr("start_timeout_s = 1.0"));
  EXPECT_EQ(pair.door->track(frame).error().message, prepared.error().message);
}

TEST(LcmEstimator, ReturnsDebugImageAndMapPointsWhenWanted) {
  const LcmPair pair = make_memq_pair();
  pair.door->set_debug(true);
  const auto estimates = fly(*pair.door, 2);
  ASSERT_TRUE(estimates[1].debug_image.has_value());
  EXPECT_EQ(estimates[1].debug_image->width_px, 32);
  EXPECT_EQ(estimates[1].debug_image->height_px, 24);
  EXPECT_EQ(estimates[1].debug_image->at(5, 5, 2), 77);
  EXPECT_EQ(estimates[1].map_points_vo,
            (std::vector<Eigen::Vector3f>{Eigen::Vector3f(1.0F, 2.0F, 3.0F)}));
}

TEST(LcmEstimator, CountsADebugImageThatDidNotCome) {
  LcmBehaviour behaviour;
  behaviour.sends_debug = false;
  const LcmPair pair = make_memq_pair(behaviour);
  pair.door->set_debug(true);
  for (const VoEstimate& estimate : fly(*pair.door, 2)) {
    EXPECT_FALSE(estimate.debug_image.has_value());
    EXPECT_THAT(estimate.counters, Contains(Pair("debug_lost", 1.0)));
  }
}

struct BadOption {
  std::string name;
  std::function<void(LcmEstimatorOptions&)> change;
  std::string complaint;
};

class LcmBadOption : public ::testing::TestWithParam<BadOption> {};

TEST_P(LcmBadOption, IsRefusedByName) {
  LcmEstimatorOptions options;
  options.url = "memq://";
  GetParam().change(options);
  const auto door = create_lcm_estimator(options);
  ASSERT_FALSE(door.ok());
  EXPECT_EQ(door.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(door.error().message, HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    Options,
    LcmBadOption,
    ::testing::Values(
        BadOption{"Prefix", [](auto& o) { o.channel_prefix = "A.*"; }, "channel_prefix = \"A.*\""},
        BadOption{
            "LongPrefix", [](auto& o) { o.channel_prefix = std::string(41, 'A'); }, "at most 40"},
        BadOption{"Start", [](auto& o) { o.start_timeout_s = 0.0; }, "start_timeout_s = 0.0"},
        BadOption{"Answer", [](auto& o) { o.answer_timeout_s = -1.0; }, "answer_timeout_s = -1.0"},
        BadOption{"Url", [](auto& o) { o.url = "nonsense"; }, "PROVIDER://NETWORK"},
        BadOption{"PlayedLog", [](auto& o) { o.url = "file:///x.lcm"; }, "mode=w"},
        BadOption{"LockstepLog", [](auto& o) { o.url = "file:///x.lcm?mode=w"; }, "lockstep"}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace overfly
