// What a run that is far behind its vehicle keeps.
#include "flight/live/live_samples.hpp"

#include <gtest/gtest.h>

#include <string>

#include "flight/mavlink/payload.hpp"

namespace overfly::flight::live {
namespace {

using mavlink::Frame;
using mavlink::PayloadWriter;

void take_message(LiveSamples& samples, std::uint32_t id, const PayloadWriter& payload) {
  const std::vector<std::uint8_t> bytes = payload.bytes();
  samples.take({mavlink::Version::kTwo, 0, 1, 1, id, false, bytes});
}

void take_state(LiveSamples& samples, std::uint32_t boot_ms) {
  take_message(samples, 30, PayloadWriter(28).put(0, boot_ms));
  take_message(samples,
               33,
               PayloadWriter(28)
                   .put(0, boot_ms)
                   .put(4, std::int32_t{392345678})
                   .put(8, std::int32_t{-861234567})
                   .put(12, std::int32_t{300000}));
}

logs::StreamId live_stream_named(const LiveSamples& samples, const std::string& name) {
  for (logs::StreamId i = 0; i < samples.streams().size(); ++i) {
    if (samples.streams()[i].description.name.find(name) != std::string::npos) return i;
  }
  ADD_FAILURE() << name;
  return 0;
}

TEST(LiveSamples, TakeNoneAfterTheFirstThatWasNotKept) {
  LiveSamples samples(0.0);
  std::uint32_t boot_ms = 1000;
  take_state(samples, boot_ms);
  const logs::StreamId position = live_stream_named(samples, "GLOBAL_POSITION_INT");
  const logs::StreamId attitude = live_stream_named(samples, "ATTITUDE");
  samples.keep_only(position, attitude);
  while (!samples.full()) take_state(samples, boot_ms += 10);
  const auto& positions = samples.streams()[position].positions;
  ASSERT_EQ(positions.size(), kMaxLiveSamples);
  const std::int64_t last_ns = positions.back().t_ns;
  // The run comes on: places are free again, but what came meanwhile is lost.
  samples.forget_before(last_ns - 1'000'000'000);
  for (int i = 0; i < 10; ++i) take_state(samples, boot_ms += 10);
  EXPECT_TRUE(samples.full());
  EXPECT_EQ(samples.streams()[position].positions.back().t_ns, last_ns);
  EXPECT_LE(samples.streams()[attitude].attitudes.back().t_ns, last_ns);
}

TEST(LiveSamples, LeaveOutFirstStampsThatAreWrong) {
  LiveSamples samples(0.0);
  take_state(samples, 4'000'000'000U);  // two messages
  EXPECT_FALSE(samples.latest_ns());
  for (const std::uint32_t boot_ms : {1000U, 1020U, 1040U}) take_state(samples, boot_ms);
  EXPECT_FALSE(samples.restarted());
  EXPECT_EQ(samples.latest_ns(), 1'040'000'000);
  // Three stamps in a row were needed to believe them.
  const auto& positions =
      samples.streams()[live_stream_named(samples, "GLOBAL_POSITION_INT")].positions;
  ASSERT_EQ(positions.size(), 2U);
  EXPECT_EQ(positions.front().t_ns, 1'020'000'000);
}

TEST(LiveSamples, AreThoseOfTheirOwnMessagesWhereTheseWereHeld) {
  LiveSamples samples(0.0);
  for (const std::uint32_t boot_ms : {1000U, 1020U}) {
    take_message(samples,
                 33,
                 PayloadWriter(28)
                     .put(0, boot_ms)
                     .put(4, std::int32_t{392345678})
                     .put(8, std::int32_t{-861234567})
                     .put(20, static_cast<std::int16_t>(boot_ms)));
  }
  EXPECT_FALSE(samples.latest_ns());
  take_message(samples, 30, PayloadWriter(28).put(0, std::uint32_t{1040}));
  const auto& positions =
      samples.streams()[live_stream_named(samples, "GLOBAL_POSITION_INT")].positions;
  ASSERT_EQ(positions.size(), 2U);
  EXPECT_DOUBLE_EQ(positions[0].v_ned_m_s.x(), 10.0);
  EXPECT_DOUBLE_EQ(positions[1].v_ned_m_s.x(), 10.2);
}

TEST(LiveSamples, KeepModesBeforeTexts) {
  LiveSamples samples(0.0);
  for (const std::uint32_t boot_ms : {1000U, 1020U}) take_state(samples, boot_ms);
  const auto heartbeat = [&](std::uint32_t mode) {
    take_message(samples,
                 0,
                 PayloadWriter(9)
                     .put(0, mode)
                     .put(4, std::uint8_t{1})
                     .put(5, std::uint8_t{3})
                     .put(6, std::uint8_t{0x81}));
  };
  heartbeat(10);
  for (std::size_t i = 0; i < 2 * kMaxLiveEvents; ++i) {
    PayloadWriter text(54);
    text.put(0, std::uint8_t{4}).put(1, static_cast<std::uint8_t>('a' + i % 26));
    take_message(samples, 253, text);
  }
  EXPECT_EQ(samples.events().size(), kMaxLiveEvents);
  EXPECT_GE(samples.lost_events(), kMaxLiveEvents);
  ASSERT_FALSE(samples.events().empty());
  EXPECT_EQ(samples.events().front().kind, FlightEventKind::kMode);
  EXPECT_EQ(samples.events().front().text, "AUTO");
}

}  // namespace
}  // namespace overfly::flight::live
