#include "flight/playback/play.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>

#include "flight/playback/link_output.hpp"
#include "flight/playback/tlog_records.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::playback {
namespace {

using std::chrono::microseconds;
using testing::append;
using testing::Bytes;
using ::testing::HasSubstr;
using testing::PeerSocket;
using Kind = PlaybackCommand::Kind;

constexpr std::int64_t kBegunUs = 1'700'000'000'000'000;
constexpr int kRecords = 100;
constexpr std::int64_t kRecordStepUs = 100'000;

Bytes played_frame(int i) {
  return testing::frame_bytes(
      30,
      testing::attitude_payload(static_cast<std::uint32_t>(100 * i), 0, 0, 0),
      static_cast<std::uint8_t>(i));
}

Bytes stamped(std::int64_t t_us, const Bytes& frame) {
  Bytes bytes;
  testing::put_big(bytes, kBegunUs + t_us);
  append(bytes, frame);
  return bytes;
}

/// Numbers of the frames in received datagrams, by the milliseconds in their attitude.
std::vector<int> numbers_in(const Bytes& bytes) {
  std::vector<int> numbers;
  mavlink::FrameFinder finder;
  std::span<const std::uint8_t> left = bytes;
  while (true) {
    const auto found = finder.next(left, true);
    if (!found.frame) return numbers;
    left = left.subspan(found.consumed_bytes);
    numbers.push_back((found.frame->payload[0] + 256 * found.frame->payload[1] +
                       65536 * found.frame->payload[2]) /
                      100);
  }
}

class PlayTlog : public ::testing::Test {
 protected:
  PlayTlog() {
    Bytes bytes;
    for (int i = 0; i < kRecords; ++i) append(bytes, stamped(i * kRecordStepUs, played_frame(i)));
    testing::write_bytes(file(), bytes);
    port_ = socket_.bind_to(0, false);
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "a.tlog"; }

  /// Plays with a clock that each look at it moves on, and commands at steps of the loop.
  std::vector<int> played(const PlaybackOptions& options,
                          std::map<int, PlaybackCommand> commands,
                          microseconds tick = microseconds(5000)) {
    auto records = TlogRecords::open(file());
    EXPECT_TRUE(records.ok()) << records.error().message;
    PlaybackPorts ports;
    PlaybackClock::TimePoint now{};
    int step = 0;
    Bytes received;
    ports.now = [&] { return now += tick; };
    ports.commands = [&] {
      // A socket holds some hundred datagrams.
      while (socket_.readable(0)) append(received, socket_.receive(0));
      std::vector<PlaybackCommand> due;
      const auto found = commands.find(step++);
      if (found != commands.end()) due.push_back(found->second);
      return due;
    };
    ports.changed = [&](const PlaybackClock& clock, std::int64_t position_us) {
      changes_.emplace_back(clock.paused(), position_us);
    };
    const std::atomic<bool> stop{false};
    const auto address =
        mavlink::parse_link_address("udp:127.0.0.1:" + std::to_string(port_), "link");
    const auto output = link_output(std::make_unique<TlogRecords>(std::move(*records)), *address);
    const auto summary = play(*output, options, ports, stop);
    EXPECT_TRUE(summary.ok()) << summary.error().message;
    while (socket_.readable(0)) append(received, socket_.receive(0));
    const std::vector<int> numbers = numbers_in(received);
    EXPECT_EQ(numbers.size(), summary->sent);
    steps_ = step;
    return numbers;
  }

  overfly::testing::TemporaryFolder folder_;
  PeerSocket socket_{SOCK_DGRAM};
  std::uint16_t port_ = 0;
  int steps_ = 0;
  std::vector<std::pair<bool, std::int64_t>> changes_;
};

std::vector<int> counting(int from, int to) {
  std::vector<int> numbers;
  for (int i = from; i < to; ++i) numbers.push_back(i);
  return numbers;
}

TEST_F(PlayTlog, SendsEveryFrameInItsOrderAtAnySpeed) {
  PlaybackOptions options;
  options.speed = 50.0;
  EXPECT_EQ(played(options, {}), counting(0, kRecords));
  const int fast_steps = steps_;
  options.speed = 5.0;
  EXPECT_EQ(played(options, {}), counting(0, kRecords));
  EXPECT_GT(steps_, 5 * fast_steps);  // a tenth of the speed
}

TEST_F(PlayTlog, StartsWhereItIsAsked) {
  PlaybackOptions options;
  options.speed = 100.0;
  options.from_us = 40 * kRecordStepUs + 1;
  EXPECT_EQ(played(options, {}), counting(41, kRecords));
}

TEST_F(PlayTlog, SeeksBackAndForth) {
  PlaybackOptions options;
  options.speed = 0.01;
  // Frame 0 is due at once; then to 5 s, back to 2 s, to 9.9 s, and on at full speed.
  const std::vector<int> numbers = played(options,
                                          {{3, {Kind::kSeek, 5.0}},
                                           {6, {Kind::kSeek, 2.0}},
                                           {9, {Kind::kSeek, 9.8}},
                                           {12, {Kind::kSpeed, 1000.0}}});
  EXPECT_EQ(numbers, (std::vector<int>{0, 50, 20, 98, 99}));
}

TEST_F(PlayTlog, SendsNothingWhilePaused) {
  PlaybackOptions options;
  options.speed = 20.0;
  const std::vector<int> numbers = played(options, {{5, {Kind::kPause}}, {30, {Kind::kPlay}}});
  EXPECT_EQ(numbers, counting(0, kRecords));
  ASSERT_EQ(changes_.size(), 2U);
  EXPECT_TRUE(changes_[0].first);
  EXPECT_FALSE(changes_[1].first);
  // The position has not moved meanwhile.
  EXPECT_EQ(changes_[1].second, changes_[0].second);
}

TEST_F(PlayTlog, EndsWhenItIsAsked) {
  PlaybackOptions options;
  options.speed = 0.01;
  EXPECT_EQ(played(options, {{5, {Kind::kQuit}}}), counting(0, 1));
}

TEST_F(PlayTlog, RepeatsFromItsStart) {
  PlaybackOptions options;
  options.speed = 1000.0;
  options.repeat = true;
  options.from_us = 97 * kRecordStepUs;
  const std::vector<int> numbers = played(options, {{60, {Kind::kQuit}}});
  ASSERT_GE(numbers.size(), 7U);
  EXPECT_EQ(std::vector<int>(numbers.begin(), numbers.begin() + 7),
            (std::vector<int>{97, 98, 99, 97, 98, 99, 97}));
}

TEST_F(PlayTlog, PassesOverDamageAndStampsThatAreWrong) {
  Bytes bytes = stamped(0, played_frame(0));
  append(bytes, Bytes(50, 0x33));
  append(bytes, stamped(100, played_frame(1)));
  append(bytes, stamped(std::int64_t{1} << 55, played_frame(2)));  // 1100 years later
  append(bytes, stamped(50, played_frame(3)));                     // earlier
  append(bytes, stamped(200, played_frame(4)));
  append(bytes, Bytes(9, 0xFD));
  testing::write_bytes(file(), bytes);
  auto records = TlogRecords::open(file());
  ASSERT_TRUE(records.ok()) << records.error().message;
  EXPECT_EQ(records->count(), 5U);
  EXPECT_EQ(records->duration_us(), 200);
  std::int64_t last_us = 0;
  for (int i = 0; i < 5; ++i) {
    const auto record = records->next();
    ASSERT_TRUE(record.ok() && *record);
    EXPECT_GE((*record)->t_us, last_us);
    last_us = (*record)->t_us;
    EXPECT_EQ(Bytes((*record)->frame.begin(), (*record)->frame.end()), played_frame(i));
  }
  testing::write_bytes(file(), Bytes(100, 1));
  EXPECT_THAT(TlogRecords::open(file()).error().message, HasSubstr("is no telemetry log"));
}

TEST_F(PlayTlog, DoesNotBelieveFirstStampsThatAreWrong) {
  constexpr std::int64_t kHourUs = 3'600'000'000;
  for (const std::int64_t wrong_us : {-5 * kHourUs, kHourUs, 9000 * kHourUs}) {
    Bytes bytes = stamped(wrong_us, played_frame(0));
    for (int i = 1; i < 6; ++i) append(bytes, stamped(100'000 * i, played_frame(i)));
    testing::write_bytes(file(), bytes);
    auto records = TlogRecords::open(file());
    ASSERT_TRUE(records.ok()) << records.error().message;
    EXPECT_EQ(records->count(), 6U);
    EXPECT_EQ(records->duration_us(), 400'000) << wrong_us;
    for (const int pass : {1, 2}) {
      for (int i = 0; i < 6; ++i) {
        const auto record = records->next();
        ASSERT_TRUE(record.ok() && *record);
        EXPECT_EQ((*record)->t_us, 100'000 * std::max(i - 1, 0)) << pass;
      }
      ASSERT_TRUE(records->seek(0).ok());
    }
  }
}

TEST(PlaybackCommands, AreReadFromLines) {
  EXPECT_EQ(parse_playback_command("pause")->kind, Kind::kPause);
  EXPECT_EQ(parse_playback_command("speed 0.5")->value, 0.5);
  EXPECT_EQ(parse_playback_command("seek 12.5")->value, 12.5);
  for (const char* wrong : {"",
                            "speed",
                            "speed 0",
                            "speed 1e9",
                            "seek -1",
                            "seek x",
                            "jump 3",
                            "seek 1 2",
                            "speed nan"}) {
    EXPECT_FALSE(parse_playback_command(wrong).ok()) << wrong;
  }
}

}  // namespace
}  // namespace overfly::flight::playback
