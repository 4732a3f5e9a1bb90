#include "vo_bridges/lcm/lcm_estimator.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <overfly_lcm/status_t.hpp>
#include <set>

#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"

namespace overfly {
namespace {

using ::testing::Contains;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::LcmBehaviour;
using testing::LcmPair;
using testing::make_memq_pair;
using ::testing::Pair;
using testing::varied_frames;

/// Long enough for an answer on a busy machine, short enough to wait for none.
LcmEstimatorOptions impatient(bool lockstep = true) {
  LcmEstimatorOptions options;
  options.lockstep = lockstep;
  options.start_timeout_s = 1.0;
  options.answer_timeout_s = 0.5;
  return options;
}

std::vector<VoEstimate> fly(VoPort& door, int count) {
  std::vector<VoEstimate> estimates;
  for (const VoFrame& frame : varied_frames(count)) {
    Result<VoEstimate> estimate = door.track(frame);
    EXPECT_TRUE(estimate.ok()) << estimate.error().message;
    if (estimate) estimates.push_back(std::move(*estimate));
  }
  return estimates;
}

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
  pair.door->reset();
  ASSERT_TRUE(pair.door->track(frames[0]).ok());
  EXPECT_EQ(pair.far_end->sessions(), 2);
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

/// How long a call takes to end with kCancelled once it is asked to.
template <typename Call>
double cancelled_after_s(std::atomic<bool>& cancel, Call call) {
  auto code = std::async(std::launch::async, call);
  EXPECT_EQ(code.wait_for(std::chrono::milliseconds(400)), std::future_status::timeout);
  const auto asked = std::chrono::steady_clock::now();
  cancel = true;
  EXPECT_EQ(code.get(), ErrorCode::kCancelled);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
}

constexpr double kBusyS = 1.0;  ///< 50 ms on a machine that has time

TEST(LcmEstimator, EndsItsWaitForAnEstimatorWhenCancelled) {
  LcmBehaviour behaviour;
  behaviour.calibrations_missed = 1000;
  for (const bool prepares : {true, false}) {
    std::atomic<bool> cancel = false;
    LcmEstimatorOptions options;
    options.start_timeout_s = 60.0;
    options.cancel = &cancel;
    const LcmPair pair = make_memq_pair(behaviour, options);
    const VoFrame frame = varied_frames(1).front();
    const double took_s = cancelled_after_s(cancel, [&] {
      return prepares ? pair.door->prepare(frame).error().code
                      : pair.door->track(frame).error().code;
    });
    EXPECT_LT(took_s, kBusyS);
  }
}

TEST(LcmEstimator, EndsItsWaitForAnAnswerWhenCancelled) {
  LcmBehaviour behaviour;
  behaviour.loses_pose = [](const overfly_lcm::pose_t& pose) { return pose.frame == 1; };
  std::atomic<bool> cancel = false;
  LcmEstimatorOptions options;
  options.answer_timeout_s = 60.0;
  options.cancel = &cancel;
  const LcmPair pair = make_memq_pair(behaviour, options);
  const auto frames = varied_frames(2);
  ASSERT_TRUE(pair.door->track(frames[0]).ok());
  const double took_s =
      cancelled_after_s(cancel, [&] { return pair.door->track(frames[1]).error().code; });
  EXPECT_LT(took_s, 1.2 + kBusyS);  // it could still come
}

template <typename Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

TEST(LcmEstimator, CleansWhatAStatusSays) {
  const LcmPair pair = make_memq_pair();
  fly(*pair.door, 1);
  overfly_lcm::status_t status{};
  status.session = pair.far_end->calibration()->session;
  status.name = "my\xFFvo";
  status.version =
      "\x01"
      "1";
  status.cpu_s = INFINITY;
  status.parameters.resize(3);
  status.parameters[0].name = "file";
  status.parameters[0].value = "caf\xC3\xA9 \xC3";
  status.parameters[1].name = "bad\xFFname";
  status.parameters[2].name = std::string(129, 'x');
  status.nparameters = 3;
  status.lines = {"at \xFE\n"};
  status.nlines = 1;
  pair.far_end->publish_raw("STATUS", bytes_of(status));
  ASSERT_TRUE(pair.door->track(varied_frames(2).back()).ok());
  EXPECT_EQ(
      pair.door->effective_parameters(),
      (std::map<std::string, std::string>{{"estimator", "my?vo ?1"}, {"file", "caf\xC3\xA9 ?"}}));
  EXPECT_EQ(pair.door->resource_use()->cpu_s, 1.25) << "of the status before";
  const auto log = pair.door->take_log();
  EXPECT_THAT(log, Contains("at ?"));
  EXPECT_THAT(log, Contains(HasSubstr("parameter \"bad?name\" left out")));
}

void add_counter(overfly_lcm::pose_t& pose, const std::string& name) {
  overfly_lcm::named_number_t& counter = pose.counters.emplace_back();
  counter.name = name;
  counter.value = 1.0;
  pose.ncounters = static_cast<std::int32_t>(pose.counters.size());
}

TEST(LcmEstimator, LeavesOutFiguresWithoutASoundName) {
  LcmBehaviour behaviour;
  behaviour.changes_pose = [](overfly_lcm::pose_t& pose) {
    add_counter(pose, "bad\xFF");
    add_counter(pose, "");
    pose.timings_ms[0].name = "two words";
  };
  const LcmPair pair = make_memq_pair(behaviour);
  for (const VoEstimate& estimate : fly(*pair.door, 2)) {
    EXPECT_EQ(estimate.counters, (std::map<std::string, double>{{"features", 64.0}}));
    EXPECT_THAT(estimate.timing_ms, IsEmpty());
  }
  const auto log = pair.door->take_log();
  EXPECT_THAT(log, Contains(HasSubstr("timing \"two words\" left out")));
  EXPECT_EQ(std::count_if(log.begin(),
                          log.end(),
                          [](const auto& l) { return l.find("left out") != std::string::npos; }),
            2)
      << "once each";
}

TEST(LcmEstimator, TakesSoManyNamesOfCountersASession) {
  LcmBehaviour behaviour;
  behaviour.changes_pose = [](overfly_lcm::pose_t& pose) {
    for (int i = 0; i < 100; ++i) {
      add_counter(pose, std::to_string(pose.frame) + "_" + std::to_string(i));
    }
  };
  const LcmPair pair = make_memq_pair(behaviour);
  std::set<std::string> names;
  for (const VoEstimate& estimate : fly(*pair.door, 5)) {
    for (const auto& [name, value] : estimate.counters) names.insert(name);
    EXPECT_TRUE(estimate.counters.contains("features")) << "a name that is known stays";
  }
  EXPECT_EQ(names.size(), 256U);
  EXPECT_THAT(pair.door->take_log(), Contains(HasSubstr("at most 256 names")));
  pair.door->reset();
  EXPECT_TRUE(pair.door->track(varied_frames(1).front())->counters.contains("0_99"));
}

TEST(LcmEstimator, SendsALostImageAgainInLockstep) {
  LcmBehaviour behaviour;
  behaviour.loses_image = [](const overfly_lcm::image_t& image) {
    return image.frame == 2 && image.sequence < 5;  // the first two times
  };
  const LcmPair pair = make_memq_pair(behaviour);
  const auto estimates = fly(*pair.door, 4);
  EXPECT_EQ(estimates[2].sample.state, TrackingState::kTracking);
  EXPECT_THAT(estimates[2].counters, Contains(Pair("images_lost", 2.0)));
  EXPECT_FALSE(estimates[2].counters.contains("unanswered"));
  EXPECT_FALSE(estimates[3].counters.contains("images_lost"));
  EXPECT_EQ(pair.far_end->images().size(), 4U);
}

TEST(LcmEstimator, CountsALostImageInRealTimeWithoutWaiting) {
  LcmBehaviour behaviour;
  behaviour.loses_image = [](const overfly_lcm::image_t& image) { return image.frame == 2; };
  LcmEstimatorOptions options;
  options.lockstep = false;
  options.answer_timeout_s = 3600.0;
  const LcmPair pair = make_memq_pair(behaviour, options);
  const auto estimates = fly(*pair.door, 4);
  EXPECT_EQ(estimates[2].sample.state, TrackingState::kLost);
  EXPECT_THAT(estimates[2].counters, Contains(Pair("images_lost", 1.0)));
  EXPECT_THAT(estimates[2].counters, Contains(Pair("unanswered", 1.0)));
  EXPECT_EQ(estimates[3].sample.state, TrackingState::kTracking);
}

TEST(LcmEstimator, GivesALostImageUpAfterSomeSends) {
  LcmBehaviour behaviour;
  behaviour.loses_image = [](const overfly_lcm::image_t& image) { return image.frame == 1; };
  const LcmPair pair = make_memq_pair(behaviour);
  const auto estimates = fly(*pair.door, 3);
  EXPECT_THAT(estimates[1].counters, Contains(Pair("images_lost", 5.0)));
  EXPECT_THAT(estimates[1].counters, Contains(Pair("unanswered", 1.0)));
  EXPECT_EQ(estimates[1].sample.state, TrackingState::kInitialising) << "no pose before";
  EXPECT_EQ(estimates[2].sample.frame, 2);
}

TEST(LcmEstimator, AsksAgainForAnAnswerThatWasLost) {
  int losses = 1;
  LcmBehaviour behaviour;
  behaviour.loses_pose = [&](const overfly_lcm::pose_t& pose) {
    return pose.frame == 1 && losses-- > 0;
  };
  const LcmPair pair = make_memq_pair(behaviour);
  const auto estimates = fly(*pair.door, 2);
  EXPECT_EQ(estimates[1].sample.state, TrackingState::kTracking);
  EXPECT_EQ(pair.far_end->images().size(), 2U) << "the image came and is not sent again";
}

TEST(LcmEstimator, CountsAnUnansweredFrameAndFliesOn) {
  LcmBehaviour behaviour;
  behaviour.loses_pose = [](const overfly_lcm::pose_t& pose) { return pose.frame == 2; };
  const LcmPair pair = make_memq_pair(behaviour, impatient());
  const auto estimates = fly(*pair.door, 4);
  ASSERT_EQ(estimates.size(), 4U);
  EXPECT_EQ(estimates[2].sample.state, TrackingState::kLost);
  EXPECT_THAT(estimates[2].counters, Contains(Pair("unanswered", 1.0)));
  EXPECT_EQ(estimates[3].sample.state, TrackingState::kTracking);
  EXPECT_THAT(pair.door->take_log(), Contains("no answer to frame 2 in time"));
}

TEST(LcmEstimator, FailsForGoodAfterFiveFramesWithoutAWord) {
  LcmBehaviour behaviour;
  behaviour.loses_pose = [](const overfly_lcm::pose_t& pose) { return pose.frame >= 2; };
  const LcmPair pair = make_memq_pair(behaviour, impatient());
  const auto frames = varied_frames(9);
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(pair.door->track(frames[i]).ok()) << i;
  const auto estimate = pair.door->track(frames[6]);
  ASSERT_FALSE(estimate.ok());
  EXPECT_EQ(estimate.error().code, ErrorCode::kInternal);
  EXPECT_THAT(estimate.error().message, HasSubstr("5 frames in a row"));
  EXPECT_FALSE(pair.door->track(frames[7]).ok());
}

TEST(LcmEstimator, CountsDuplicateAndStrangeAnswers) {
  LcmBehaviour behaviour;
  behaviour.answers_each = 3;
  const LcmPair pair = make_memq_pair(behaviour);
  double duplicates = 0.0;
  for (VoEstimate& estimate : fly(*pair.door, 20)) {
    duplicates += estimate.counters["answers_duplicate"];
    EXPECT_FALSE(estimate.counters.contains("answers_unknown"));
  }
  // Those of the last frame may be on their way still.
  EXPECT_GE(duplicates, 38.0);
  EXPECT_LE(duplicates, 40.0);
}

TEST(LcmEstimator, CountsAnswersToFramesThatNeverWere) {
  LcmBehaviour behaviour;
  behaviour.changes_pose = [](overfly_lcm::pose_t& pose) {
    if (pose.frame == 1) pose.t_ns += 5;
    if (pose.frame == 2) pose.session += 1;
  };
  const LcmPair pair = make_memq_pair(behaviour, impatient());
  const auto estimates = fly(*pair.door, 4);
  EXPECT_THAT(estimates[1].counters, Contains(Pair("answers_unknown", Ge(1.0))));
  EXPECT_THAT(estimates[1].counters, Contains(Pair("unanswered", 1.0)));
  EXPECT_THAT(estimates[2].counters, Contains(Pair("answers_unknown", Ge(1.0))));
  EXPECT_EQ(estimates[3].sample.state, TrackingState::kTracking);
}

struct BadPose {
  std::string name;
  std::function<void(overfly_lcm::pose_t&)> change;
  std::string complaint;
};

class LcmBadPose : public ::testing::TestWithParam<BadPose> {};

TEST_P(LcmBadPose, IsLostAndTheLogSaysWhy) {
  LcmBehaviour behaviour;
  behaviour.changes_pose = [](overfly_lcm::pose_t& pose) {
    if (pose.frame == 2) GetParam().change(pose);
  };
  const LcmPair pair = make_memq_pair(behaviour);
  const auto estimates = fly(*pair.door, 4);
  EXPECT_EQ(estimates[2].sample.state, TrackingState::kLost);
  EXPECT_THAT(estimates[2].counters, Contains(Pair("messages_refused", 1.0)));
  EXPECT_EQ(estimates[3].sample.state, TrackingState::kTracking);
  EXPECT_THAT(pair.door->take_log(), Contains(HasSubstr("OVERFLY_POSE: " + GetParam().complaint)));
}

INSTANTIATE_TEST_SUITE_P(
    Fields,
    LcmBadPose,
    ::testing::Values(
        BadPose{"State", [](auto& pose) { pose.state = 7; }, "state = 7: must be 0, 1 or 2"},
        BadPose{"Map", [](auto& pose) { pose.map_id = -1; }, "map_id = -1: must be 0 or more"},
        BadPose{"Position",
                [](auto& pose) { pose.position[1] = std::nan(""); },
                "position = not finite"},
        BadPose{
            "Rotation", [](auto& pose) { pose.orientation[3] = 2.0; }, "norm of orientation = 2.0"},
        BadPose{"NoRotation",
                [](auto& pose) { pose.orientation[2] = pose.orientation[3] = std::nan(""); },
                "norm of orientation = nan"}),
    [](const auto& instance) { return instance.param.name; });

/// A valid pose with lengths that its bytes do not hold.
std::vector<std::uint8_t> pose_with_absurd_length() {
  overfly_lcm::pose_t pose{};
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(pose.getEncodedSize()));
  pose.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  // ncounters is the last but one of two int32.
  for (std::size_t i = bytes.size() - 8; i < bytes.size() - 4; ++i) bytes[i] = 0xFF;
  return bytes;
}

TEST(LcmEstimator, RefusesGarbageOnEveryChannelAndFliesOn) {
  const LcmPair pair = make_memq_pair();
  const auto frames = varied_frames(3);
  ASSERT_TRUE(pair.door->track(frames[0]).ok());
  for (const char* channel : {"POSE", "STATUS", "DEBUG"}) {
    pair.far_end->publish_raw(channel, {});
    pair.far_end->publish_raw(channel, std::vector<std::uint8_t>(100, 0xA5));
  }
  pair.far_end->publish_raw("POSE", pose_with_absurd_length());
  const auto estimate = pair.door->track(frames[1]);
  ASSERT_TRUE(estimate.ok());
  EXPECT_EQ(estimate->sample.state, TrackingState::kTracking);
  EXPECT_THAT(estimate->counters, Contains(Pair("messages_refused", 7.0)));
  EXPECT_THAT(pair.door->take_log(), Contains(HasSubstr("OVERFLY_DEBUG: not an overfly_lcm")));
}

TEST(LcmEstimator, KeepsABoundedLogInAFlood) {
  const LcmPair pair = make_memq_pair();
  ASSERT_TRUE(pair.door->track(varied_frames(1).front()).ok());
  for (int i = 0; i < 2000; ++i) pair.far_end->publish_raw("POSE", {1, 2, 3});
  const auto estimate = pair.door->track(varied_frames(2).back());
  EXPECT_THAT(estimate->counters, Contains(Pair("messages_refused", 2000.0)));
  EXPECT_LE(pair.door->take_log().size(), 30U);
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

TEST(LcmEstimator, BeginsASessionAtEachReset) {
  LcmPair pair = make_memq_pair();
  fly(*pair.door, 3);
  pair.door->reset();
  const auto again = fly(*pair.door, 2);
  EXPECT_EQ(again[0].sample.state, TrackingState::kInitialising);
  EXPECT_EQ(pair.far_end->sessions(), 2);
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
