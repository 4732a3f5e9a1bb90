// A flight of known motion, in closed form.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/earth/geodesy.hpp"
#include "core/motion/truth_source.hpp"
#include "core/time.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight::testing {

inline constexpr std::int64_t kCircleLogStartNs = 12'345'600'000;

inline LocalFrame frame_of_circles() { return LocalFrame(geodetic_from_deg(47.3, 8.5, 500.0)); }

/// Circles of 200 m at 25 m/s with a climb of 2 m/s, in closed form.
class CircleFlight final : public TruthSource {
 public:
  explicit CircleFlight(double length_s,
                        std::optional<std::int64_t> log_start_ns = kCircleLogStartNs)
      : length_s_(length_s), log_start_ns_(log_start_ns) {}
  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override {
    return ns_from_s(length_s_);
  }
  [[nodiscard]] std::string description() const override { return "circles"; }
  [[nodiscard]] std::optional<std::int64_t> log_start_ns() const override { return log_start_ns_; }

  static AircraftState at(std::int64_t t_ns) {
    constexpr double kRadiusM = 200.0;
    constexpr double kRateRadS = 25.0 / kRadiusM;
    const double t = s_from_ns(t_ns);
    const double angle = kRateRadS * t;
    AircraftState state;
    state.t_ns = t_ns;
    state.T_world_body.translation = {
        kRadiusM * std::sin(angle), kRadiusM * std::cos(angle), 100.0 + 2.0 * t};
    state.v_body_world_m_s = {25.0 * std::cos(angle), -25.0 * std::sin(angle), 2.0};
    // Heading east at first, turning right.
    state.T_world_body.rotation =
        logs::R_enu_ned() *
        Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * kPi + angle, Eigen::Vector3d::UnitZ())) *
        Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
    state.omega_body_rad_s = {0.0, kRateRadS * std::sin(0.4), kRateRadS * std::cos(0.4)};
    return state;
  }

 private:
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* /*cancel*/) override {
    if (t_ns > ns_from_s(length_s_)) return std::optional<AircraftState>();
    return std::optional(at(t_ns));
  }

  double length_s_;
  std::optional<std::int64_t> log_start_ns_;
};

}  // namespace overfly::flight::testing
