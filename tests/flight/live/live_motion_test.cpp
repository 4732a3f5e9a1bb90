// States between the samples of a live vehicle, against closed forms.
#include "flight/live/live_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/time.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight::live {
namespace {

constexpr std::int64_t kStepNs = kNsPerS / 50;

LocalFrame motion_frame() { return LocalFrame(geodetic_from_deg(46.5, 7.5, 0.0)); }

LivePosition position_at(int step, double alt_m, double indicated_airspeed_m_s) {
  return {step * kStepNs, {46.5, 7.5, alt_m}, {20.0, 0.0, 0.0}, true, indicated_airspeed_m_s};
}

/// A turn at 0.5 rad/s to the right.
LiveAttitude attitude_at(int step, bool has_rate) {
  const double yaw_rad = 0.5 * s_from_ns(step * kStepNs);
  const Eigen::AngleAxisd yaw(yaw_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d rate =
      has_rate ? Eigen::Vector3d(0.0, 0.0, 0.5) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  return {step * kStepNs, Eigen::Quaterniond(yaw), rate, has_rate};
}

TEST(LiveMotion, HasTheRateOfATurnAtEachTimeWithOrWithoutReportedRates) {
  for (const bool has_rate : {true, false}) {
    LiveMotion motion(motion_frame(), 0.0, kNsPerS);
    std::deque<LivePosition> positions;
    std::deque<LiveAttitude> attitudes;
    for (int step = 0; step < 5; ++step) {
      positions.push_back(position_at(step, 500.0, -1.0));
      attitudes.push_back(attitude_at(step, has_rate));
    }
    // At samples and between them.
    for (std::int64_t t_ns = 0; t_ns <= 4 * kStepNs; t_ns += kStepNs / 2) {
      const AircraftState state = motion.at(positions, attitudes, true, t_ns);
      EXPECT_NEAR(state.omega_body_rad_s.z(), 0.5, 1e-9) << t_ns << " " << has_rate;
      EXPECT_NEAR(state.omega_body_rad_s.head<2>().norm(), 0.0, 1e-9);
    }
  }
}

TEST(LiveMotion, TurnsTheIndicatedAirspeedIntoTheTrueOne) {
  // U.S. Standard Atmosphere, 1976, table I: density 0.90925 kg/m^3 at a geometric height of 3 km.
  LiveMotion motion(motion_frame(), 0.0, kNsPerS);
  const std::deque<LivePosition> positions = {position_at(0, 3000.0, 25.0),
                                              position_at(1, 3000.0, 25.0)};
  const std::deque<LiveAttitude> attitudes = {attitude_at(0, true), attitude_at(1, true)};
  EXPECT_NEAR(motion.at(positions, attitudes, true, kStepNs / 2).airspeed_m_s,
              25.0 * std::sqrt(1.225 / 0.90925),
              0.01);
}

TEST(LiveMotion, NeverMixesAnUnknownAirspeedIntoAKnownOne) {
  LiveMotion motion(motion_frame(), 0.0, kNsPerS);
  // The first VFR_HUD comes between two positions; the ground speed is 20 m/s.
  const std::deque<LivePosition> positions = {position_at(0, 0.0, -1.0), position_at(1, 0.0, 24.0)};
  const std::deque<LiveAttitude> attitudes = {attitude_at(0, true), attitude_at(1, true)};
  EXPECT_NEAR(motion.at(positions, attitudes, true, 0).airspeed_m_s, 20.0, 1e-6);
  EXPECT_NEAR(motion.at(positions, attitudes, true, kStepNs / 2).airspeed_m_s, 22.0, 1e-3);
  EXPECT_NEAR(motion.at(positions, attitudes, true, kStepNs).airspeed_m_s, 24.0, 1e-3);
}

}  // namespace
}  // namespace overfly::flight::live
