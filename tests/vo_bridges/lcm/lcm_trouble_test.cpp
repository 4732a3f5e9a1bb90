// Estimators that say what they must not.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <overfly_lcm/status_t.hpp>
#include <set>

#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"
#include "vo_bridges/pose_intake.hpp"

namespace overfly {
namespace {

using ::testing::Contains;
using testing::fly;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::LcmBehaviour;
using testing::LcmPair;
using testing::make_memq_pair;
using ::testing::Pair;
using testing::varied_frames;

template <typename Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

TEST(LcmTrouble, CleansWhatAStatusSays) {
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
  EXPECT_THAT(log, Contains(HasSubstr("parameter \"bad?name\" ignored")));
}

void add_counter(overfly_lcm::pose_t& pose, const std::string& name) {
  overfly_lcm::named_number_t& counter = pose.counters.emplace_back();
  counter.name = name;
  counter.value = 1.0;
  pose.ncounters = static_cast<std::int32_t>(pose.counters.size());
}

TEST(LcmTrouble, LeavesOutFiguresWithoutASoundName) {
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
  EXPECT_THAT(log, Contains(HasSubstr("timing \"two words\" ignored")));
  EXPECT_EQ(std::count_if(log.begin(),
                          log.end(),
                          [](const auto& l) { return l.find("ignored") != std::string::npos; }),
            2)
      << "once each";
}

TEST(LcmTrouble, TakesSoManyNamesOfCountersASession) {
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

TEST(LcmTrouble, GivesUpAnEstimatorWithoutAUsablePose) {
  LcmBehaviour behaviour;
  behaviour.changes_pose = [](overfly_lcm::pose_t& pose) { pose.position[0] = std::nan(""); };
  const LcmPair pair = make_memq_pair(behaviour);
  const auto frames = varied_frames(PoseIntake::kMostInARow + 2);
  // It claims its first pose with the second image.
  for (int i = 0; i < PoseIntake::kMostInARow; ++i) {
    const auto estimate = pair.door->track(frames[static_cast<std::size_t>(i)]);
    ASSERT_TRUE(estimate.ok()) << estimate.error().message;
    EXPECT_EQ(estimate->sample.state, i == 0 ? TrackingState::kInitialising : TrackingState::kLost);
  }
  const auto last = pair.door->track(frames[PoseIntake::kMostInARow]);
  ASSERT_FALSE(last.ok());
  EXPECT_EQ(last.error().code, ErrorCode::kInternal);
  EXPECT_THAT(last.error().message, HasSubstr("30 answers in a row had no usable pose"));
  EXPECT_EQ(pair.door->track(frames.back()).error().message, last.error().message);
}

/// A valid pose with lengths that its bytes do not hold.
std::vector<std::uint8_t> pose_with_absurd_length() {
  overfly_lcm::pose_t pose{};
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(pose.getEncodedSize()));
  pose.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  // ncounters is the last but one of two int32.
  for (std::size_t i = bytes.size() - 8; i < bytes.size() - 4; ++i) bytes[i] = 0xFF;
  return bytes;
}

TEST(LcmTrouble, RefusesGarbageOnEveryChannelAndFliesOn) {
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

TEST(LcmTrouble, KeepsABoundedLogInAFlood) {
  const LcmPair pair = make_memq_pair();
  ASSERT_TRUE(pair.door->track(varied_frames(1).front()).ok());
  for (int i = 0; i < 2000; ++i) pair.far_end->publish_raw("POSE", {1, 2, 3});
  const auto estimate = pair.door->track(varied_frames(2).back());
  EXPECT_THAT(estimate->counters, Contains(Pair("messages_refused", 2000.0)));
  EXPECT_LE(pair.door->take_log().size(), 30U);
}

}  // namespace
}  // namespace overfly
