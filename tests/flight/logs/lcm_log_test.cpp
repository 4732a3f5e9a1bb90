#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::Bytes;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::lcm_event;
using testing::lcm_truth;
using testing::put_big;

constexpr std::int64_t kEpochUs = 1'700'000'000'000'000;

/// Ten truths in steps of 100 ms, and a message of a type that is not Overfly's after each.
Bytes lcm_flight() {
  Bytes bytes;
  for (int i = 0; i < 10; ++i) {
    append(
        bytes,
        lcm_event(
            2 * i,
            kEpochUs + 100'000 * i,
            "CAM_TRUTH",
            lcm_truth(i * kNsPerS / 10,
                      {1.0 * i, 2.0, 300.0},
                      Eigen::Quaterniond(Eigen::AngleAxisd(EIGEN_PI, Eigen::Vector3d::UnitX())))));
    append(bytes, lcm_event(2 * i + 1, kEpochUs + 100'000 * i, "OTHER", Bytes(20, 1)));
  }
  return bytes;
}

class LcmLog : public ::testing::Test {
 protected:
  Result<OpenedLog> open_bytes(const Bytes& bytes) {
    testing::write_bytes(folder_.path() / "flight.lcm", bytes);
    return open_log(folder_.path() / "flight.lcm");
  }
  overfly::testing::TemporaryFolder folder_;
};

TEST_F(LcmLog, ReadsTheTruthOfAnyChannel) {
  const auto log = open_bytes(lcm_flight());
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->format, LogFormat::kLcm);
  EXPECT_THAT(log->warnings, ::testing::Each(HasSubstr("stays on the ground")));
  ASSERT_EQ(log->streams.size(), 2U);
  EXPECT_EQ(log->streams[0].description.name, "CAM_TRUTH");
  EXPECT_EQ(log->streams[0].description.origin, SourceOrigin::kSimulation);
  EXPECT_EQ(log->streams[0].first_ns, 0);
  EXPECT_EQ(log->streams[1].messages, 10U);
  EXPECT_EQ(log->streams[1].first_ns, kEpochUs * 1000);
  const auto trajectory = read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_EQ(trajectory->poses.size(), 10U);
  const LogPose& last = trajectory->poses.back();
  EXPECT_EQ(last.t_ns, 9 * kNsPerS / 10);
  EXPECT_EQ(last.position, Eigen::Vector3d(2.0, 9.0, -300.0));
  // The camera's x is east, y (image down) is south, z is down: the top of the image, and with it
  // the nose, is to the north.
  EXPECT_LT(rotation_angle_rad(last.R_ned_body, Eigen::Quaterniond::Identity()), 1e-6);
}

TEST_F(LcmLog, FindsTheNextEventAfterDamage) {
  Bytes bytes = lcm_flight();
  append(bytes, Bytes(100, 0xED));
  append(bytes, lcm_event(20, kEpochUs + 1'000'000, "OTHER", Bytes(20, 1)));
  Bytes cut = lcm_event(21, kEpochUs + 1'100'000, "OTHER", Bytes(20, 1));
  cut.resize(cut.size() - 1);
  append(bytes, cut);
  const auto log = open_bytes(bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  // The event in front of the damage is not believed, because no event follows it.
  const std::size_t event_bytes = cut.size() + 1;
  EXPECT_EQ(log->streams[1].messages, 10U);
  EXPECT_THAT(log->warnings,
              Contains(HasSubstr(std::to_string(event_bytes + 100 + cut.size()) +
                                 " bytes in 2 places belong to no complete event")));
}

TEST_F(LcmLog, DoesNotBelieveWrongLengths) {
  for (const std::int32_t length : {-1, std::int32_t{0x7FFFFFFF}, 100'000, 30}) {
    Bytes event = lcm_event(0, kEpochUs, "OTHER", Bytes(20, 1));
    Bytes raw;
    put_big(raw, length);
    std::copy(raw.begin(), raw.end(), event.begin() + 24);
    append(event, lcm_flight());
    const auto log = open_bytes(event);
    if (length != 30) {
      // The first event decides the format.
      EXPECT_EQ(log.ok(), length == 0x7FFFFFFF || length == 100'000) << length;
    }
    if (!log.ok()) continue;
    EXPECT_GE(log->streams[0].messages, 9U) << length;
    EXPECT_THAT(log->warnings, Contains(HasSubstr("belong to no complete event"))) << length;
  }
}

/// A flipped bit in the length of one event must not cost those that follow.
TEST_F(LcmLog, LooksBehindLongEventsBeforeItBelievesThem) {
  const auto image = [](int i) {
    return lcm_event(i, kEpochUs + i, "IMAGE", Bytes(100'000, static_cast<std::uint8_t>(i)));
  };
  Bytes bytes;
  for (int i = 0; i < 5; ++i) append(bytes, image(i));
  Bytes damaged = lcm_event(5, kEpochUs + 5, "IMAGE", Bytes(100'000, 1));
  damaged[25] ^= 0x10;  // 1 MiB longer
  append(bytes, damaged);
  for (int i = 6; i < 26; ++i) append(bytes, image(i));
  const auto log = open_bytes(bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->streams.size(), 1U);
  EXPECT_EQ(log->streams[0].messages, 25U);
  EXPECT_THAT(log->warnings,
              Contains(HasSubstr(std::to_string(damaged.size()) +
                                 " bytes in 1 place belong to no complete event")));
}

TEST_F(LcmLog, CountsMessagesThatAreTooShort) {
  Bytes bytes = lcm_flight();
  Bytes truth = lcm_truth(kNsPerS, {1, 2, 3}, Eigen::Quaterniond::Identity());
  truth.resize(60);
  append(bytes, lcm_event(20, kEpochUs, "CAM_TRUTH", truth));
  truth.resize(10);
  append(bytes, lcm_event(21, kEpochUs, "CAM_TRUTH", truth));
  const auto log = open_bytes(bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[0].messages, 12U);
  EXPECT_EQ(log->streams[0].positions, 10U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("2 messages are shorter than their type")));
}

TEST_F(LcmLog, CannotBeMadeToTakeAnyNumberOfChannels) {
  Bytes bytes;
  for (int i = 0; i < 5000; ++i) {
    append(bytes, lcm_event(i, kEpochUs, "C" + std::to_string(i), {1}));
  }
  const auto log = open_bytes(bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams.size(), 4096U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("904 events were left out")));
}

}  // namespace
}  // namespace overfly::flight::logs
