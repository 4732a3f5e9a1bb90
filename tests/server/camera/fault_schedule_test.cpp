// Which frames a fault touches, and how.
#include "server/camera/faults/fault_schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::small_scenario;

/// Frames of the first `count` that get lost; 10 Hz.
std::vector<std::int64_t> dropped(const Scenario& scenario, std::int64_t count) {
  FaultSchedule schedule(scenario);
  std::vector<std::int64_t> frames;
  for (std::int64_t k = 0; k < count; ++k) {
    const FrameFaults faults = schedule.at(0, k, frame_time_ns(k, scenario.rate));
    EXPECT_EQ(faults.dropped, !faults.names.empty());
    if (faults.dropped) frames.push_back(k);
  }
  return frames;
}

TEST(FaultSchedule, DropsAllOrEveryNthOrSome) {
  const auto all =
      small_scenario({R"(faults=[{"kind":"dropped_frames","at_s":0.5,"duration_s":0.3}])"});
  EXPECT_THAT(dropped(all, 20), ElementsAre(5, 6, 7));
  const auto third = small_scenario(
      {R"(faults=[{"kind":"dropped_frames","at_s":0.41,"duration_s":1,"every":3}])"});
  EXPECT_THAT(dropped(third, 20), ElementsAre(5, 8, 11, 14));
  const auto some =
      small_scenario({R"(faults=[{"kind":"dropped_frames","at_s":0,"probability":0.3}])"});
  const auto frames = dropped(some, 10000);
  // Binomial: 3000 with a standard deviation of 46.
  EXPECT_NEAR(static_cast<double>(frames.size()), 3000.0, 200.0);
  EXPECT_EQ(frames, dropped(some, 10000));
  const auto other = small_scenario(
      {"seed=2", R"(faults=[{"kind":"dropped_frames","at_s":0,"probability":0.3}])"});
  EXPECT_NE(frames, dropped(other, 10000));
}

TEST(FaultSchedule, JitterIsNormalAndStampsGrow) {
  const auto scenario = small_scenario(
      {"camera.rate_hz=20", R"(faults=[{"kind":"stamp_jitter","at_s":0,"sigma_ms":5}])"});
  FaultSchedule schedule(scenario);
  double sum = 0.0;
  double squares = 0.0;
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  constexpr int kFrames = 4000;
  for (int k = 0; k < kFrames; ++k) {
    const std::int64_t t_ns = frame_time_ns(k, scenario.rate);
    const FrameFaults faults = schedule.at(0, k, t_ns);
    const double offset_ms = 1e-6 * static_cast<double>(faults.stamp_ns - t_ns);
    sum += offset_ms;
    squares += offset_ms * offset_ms;
    EXPECT_GT(faults.stamp_ns, last_ns);
    last_ns = faults.stamp_ns;
  }
  // Standard errors 0.08 and 0.06 ms.
  EXPECT_NEAR(sum / kFrames, 0.0, 0.35);
  EXPECT_NEAR(std::sqrt(squares / kFrames), 5.0, 0.25);
}

TEST(FaultSchedule, AnOffsetThatEndsDoesNotTurnTimeBack) {
  const auto scenario = small_scenario(
      {R"(faults=[{"kind":"stamp_offset","at_s":0.5,"duration_s":0.5,"offset_ms":250}])"});
  FaultSchedule schedule(scenario);
  std::vector<std::int64_t> offsets_us;
  for (std::int64_t k = 0; k < 14; ++k) {
    const std::int64_t t_ns = frame_time_ns(k, scenario.rate);
    offsets_us.push_back((schedule.at(0, k, t_ns).stamp_ns - t_ns) / 1000);
  }
  EXPECT_THAT(
      offsets_us,
      ElementsAre(0, 0, 0, 0, 0, 250000, 250000, 250000, 250000, 250000, 150001, 50002, 0, 0));
}

TEST(FaultNews, TellsBeginningAndEndOnce) {
  const auto scenario = small_scenario(
      {R"(faults=[{"kind":"blackout","at_s":0.5,"duration_s":0.25},{"kind":"dirt","at_s":0.7}])"});
  FaultNews news(scenario);
  std::vector<std::string> lines;
  for (std::int64_t k = 0; k < 20; ++k) {
    for (const auto& line : news.at(frame_time_ns(k, scenario.rate))) lines.push_back(line.text);
  }
  EXPECT_THAT(
      lines,
      ElementsAre("blackout begins, for 0.25 s", "dirt begins, to the end", "blackout ends"));
  EXPECT_THAT(FaultNews(scenario).at(0), IsEmpty());
}

}  // namespace
}  // namespace overfly::server
