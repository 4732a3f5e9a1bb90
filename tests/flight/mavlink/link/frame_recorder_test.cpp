#include "flight/mavlink/link/frame_recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flight/logs/flight_log.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::mavlink {
namespace {

using std::chrono::microseconds;
using std::chrono::system_clock;
using testing::Bytes;
using ::testing::HasSubstr;

constexpr std::int64_t kFirstReceivedUs = 1'700'000'000'000'000;

Bytes recorded_frame(int i) {
  return testing::frame_bytes(
      30,
      testing::attitude_payload(static_cast<std::uint32_t>(100 * i), 0, 0, 0),
      static_cast<std::uint8_t>(i));
}

system_clock::time_point received_at(int i) {
  return system_clock::time_point(microseconds(kFirstReceivedUs + i));
}

/// The file that must be made of the first `count` frames.
std::string expected_file(int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i) {
    const auto us = static_cast<std::uint64_t>(kFirstReceivedUs + i);
    for (int shift = 56; shift >= 0; shift -= 8) {
      bytes += static_cast<char>(us >> static_cast<unsigned>(shift));
    }
    const Bytes frame = recorded_frame(i);
    bytes.append(frame.begin(), frame.end());
  }
  return bytes;
}

class FrameRecording : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "a.tlog"; }
  overfly::testing::TemporaryFolder folder_;
};

TEST_F(FrameRecording, HoldsEveryByteAndIsATelemetryLog) {
  {
    auto recorder = FrameRecorder::create(file());
    ASSERT_TRUE(recorder.ok()) << recorder.error().message;
    for (int i = 0; i < 2000; ++i) (*recorder)->add(recorded_frame(i), received_at(i));
    EXPECT_EQ((*recorder)->problem(), "");
  }
  EXPECT_EQ(overfly::testing::read_text(file()), expected_file(2000));
  const auto log = logs::open_log(file());
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->format, logs::LogFormat::kTlog);
  EXPECT_EQ(log->streams.at(0).messages, 2000U);
}

TEST_F(FrameRecording, EndsAtItsLimitWithWholeFramesAndSaysSo) {
  {
    auto recorder = FrameRecorder::create(file(), expected_file(10).size() + 5);
    ASSERT_TRUE(recorder.ok());
    for (int i = 0; i < 13; ++i) (*recorder)->add(recorded_frame(i), received_at(i));
    EXPECT_THAT((*recorder)->problem(), HasSubstr("3 messages of the vehicle were not recorded"));
  }
  EXPECT_EQ(overfly::testing::read_text(file()), expected_file(10));
}

TEST_F(FrameRecording, CutOffIsReadUpToTheLastWholeFrame) {
  {
    auto recorder = FrameRecorder::create(file());
    for (int i = 0; i < 100; ++i) (*recorder)->add(recorded_frame(i), received_at(i));
  }
  std::filesystem::resize_file(file(), expected_file(50).size() + 11);
  const auto log = logs::open_log(file());
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams.at(0).messages, 50U);
}

TEST_F(FrameRecording, DoesNotOverwriteAFile) {
  overfly::testing::write_text(file(), "precious");
  const auto recorder = FrameRecorder::create(file());
  ASSERT_FALSE(recorder.ok());
  EXPECT_THAT(recorder.error().message, HasSubstr("a.tlog: cannot be created"));
}

}  // namespace
}  // namespace overfly::flight::mavlink
