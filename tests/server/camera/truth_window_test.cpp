// The truth while the shutter is open.
#include "server/camera/truth_window.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/time.hpp"

namespace overfly::server {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// 20 m/s east and 0.5 rad/s of yaw for 1 s. Fails a test that goes back in time.
class Turning final : public TruthSource {
 public:
  std::optional<std::int64_t> duration_ns() const override { return kNsPerS; }
  std::string description() const override { return "turning"; }

  static AircraftState truth(std::int64_t t_ns) {
    AircraftState state;
    state.t_ns = t_ns;
    state.T_world_body.translation = {20.0 * s_from_ns(t_ns), 0.0, 100.0};
    state.T_world_body.rotation =
        Eigen::AngleAxisd(0.5 * s_from_ns(t_ns), Eigen::Vector3d::UnitZ());
    state.v_body_world_m_s = {20.0, 0.0, 0.0};
    state.omega_body_rad_s = {0.0, 0.0, 0.5};
    return state;
  }
  static std::vector<std::int64_t> asked_ns_;

 private:
  Result<std::optional<AircraftState>> find_state(std::int64_t t_ns,
                                                  const std::atomic<bool>* /*cancel*/) override {
    EXPECT_GE(t_ns, last_ns_) << "asked for the past";
    last_ns_ = t_ns;
    asked_ns_.push_back(t_ns);
    if (t_ns > kNsPerS) return std::optional<AircraftState>();
    return std::optional(truth(t_ns));
  }

  std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
};
std::vector<std::int64_t> Turning::asked_ns_;

/// Of the next frame, beyond all windows.
constexpr std::int64_t kLater = 10 * kNsPerS;

void expect_truth(const AircraftState& state) {
  const AircraftState truth = Turning::truth(state.t_ns);
  EXPECT_LT((state.T_world_body.translation - truth.T_world_body.translation).norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(state.T_world_body.rotation, truth.T_world_body.rotation), 1e-7);
}

TEST(TruthWindow, LiesOnARasterAroundTheFrameAndReachesItsEnds) {
  TruthWindow window(std::make_unique<Turning>());
  const auto states = window.around(100 * kMs, 3 * kMs + 1, kMs, kLater);
  ASSERT_TRUE(states.ok() && states->has_value());
  ASSERT_EQ((*states)->size(), 9U);
  for (std::int64_t j = -4; j <= 4; ++j) {
    EXPECT_EQ((**states)[static_cast<std::size_t>(j + 4)].t_ns, 100 * kMs + j * kMs);
  }
  for (const AircraftState& state : **states) expect_truth(state);
}

TEST(TruthWindow, OfAnInstantAsksOnce) {
  Turning::asked_ns_.clear();
  TruthWindow window(std::make_unique<Turning>());
  const auto states = window.around(100 * kMs, 0, kMs, kLater);
  ASSERT_TRUE(states.ok() && states->has_value());
  EXPECT_EQ((*states)->size(), 1U);
  EXPECT_EQ(Turning::asked_ns_.size(), 1U);
}

TEST(TruthWindow, GoesOnBeforeTheBeginningAndAfterTheEnd) {
  TruthWindow window(std::make_unique<Turning>());
  const auto first = window.around(0, 5 * kMs, kMs, kLater);
  ASSERT_TRUE(first.ok() && first->has_value());
  EXPECT_EQ((*first)->front().t_ns, -5 * kMs);
  for (const AircraftState& state : **first) expect_truth(state);
  const auto last = window.around(kNsPerS, 5 * kMs, kMs, kLater);
  ASSERT_TRUE(last.ok() && last->has_value());
  EXPECT_EQ((*last)->back().t_ns, kNsPerS + 5 * kMs);
  for (const AircraftState& state : **last) expect_truth(state);
  const auto over = window.around(kNsPerS + kMs, 0, kMs, kLater);
  ASSERT_TRUE(over.ok());
  EXPECT_FALSE(over->has_value());
}

TEST(TruthWindow, SharesWhatOverlapsWithoutGoingBack) {
  // 32 ms apart, 25 ms to either side, on a raster that does not divide the step.
  TruthWindow window(std::make_unique<Turning>());
  for (std::int64_t t_ns = 0; t_ns < 900 * kMs; t_ns += 32'258'065) {
    const auto states = window.around(t_ns, 25 * kMs, kMs, kLater);
    ASSERT_TRUE(states.ok() && states->has_value());
    for (const AircraftState& state : **states) expect_truth(state);
  }
}

/// At 60 Hz with readout and exposure of 16.6 ms the raster goes beyond the next frame.
TEST(TruthWindow, AsksForTheNextFrameBeforeItGoesBeyond) {
  Turning::asked_ns_.clear();
  TruthWindow window(std::make_unique<Turning>());
  constexpr std::int64_t kPeriodNs = 16'666'667;
  for (std::int64_t k = 0; k < 50; ++k) {
    const auto states = window.around(k * kPeriodNs, 16'600'000, kMs, (k + 1) * kPeriodNs);
    ASSERT_TRUE(states.ok() && states->has_value());
    EXPECT_EQ((*states)->size(), 35U);
    EXPECT_THAT(Turning::asked_ns_, ::testing::Contains(k * kPeriodNs));
    expect_truth((**states)[17]);
  }
}

}  // namespace
}  // namespace overfly::server
