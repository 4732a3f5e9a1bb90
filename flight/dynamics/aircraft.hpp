// A fixed-wing aircraft in flight: the airframe's forces, its actuators, the wind, and time.
#pragma once

#include <cstdint>
#include <optional>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "flight/dynamics/actuators.hpp"
#include "flight/dynamics/airframe.hpp"
#include "flight/dynamics/environment.hpp"
#include "flight/dynamics/rigid_body.hpp"
#include "flight/dynamics/turbulence.hpp"

namespace overfly::dynamics {

/// Longest step of Aircraft::step [s].
inline constexpr double kStepMaxS = 0.02;
/// The coefficients of an airframe describe no faster motion.
inline constexpr double kSpeedMaxMS = 1000.0;
inline constexpr double kRateMaxRadS = 1000.0;

/// What the aircraft's probes measure without error.
struct AirData {
  double airspeed_m_s = 0.0;
  double alpha_rad = 0.0;  ///< angle of attack, (-pi, pi]; 0 without airspeed
  double beta_rad = 0.0;   ///< sideslip, [-pi/2, pi/2]; wind from the right is positive
  double density_kg_m3 = 0.0;
};

struct AircraftSetup {
  Airframe airframe;
  Environment environment;
  /// Velocity of the air relative to world, expressed in world [m/s].
  Eigen::Vector3d wind_world_m_s = Eigen::Vector3d::Zero();
  std::optional<TurbulenceLevel> turbulence = {};
  std::uint64_t turbulence_seed = 0;
};

/// Flies an airframe in steps of time. A controller reads state(), air_data() and specific_force(),
/// and gives the commands of the next step. The result is a function of setup, start, commands and
/// steps. There is no ground: the aircraft falls through it.
class Aircraft {
 public:
  /// @param start      attitude a unit quaternion within 1e-6, speed up to 300 m/s, rate up to
  ///                   100 rad/s
  /// @param positions  of the actuators; limited to the airframe's ranges
  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] static Result<Aircraft> create(const AircraftSetup& setup,
                                               const BodyState& start,
                                               const Controls& positions);

  /// Advances by one step with constant commands (see `advance` of the actuators). The gust is
  /// constant during the step. A step that is long for the aircraft's speed and rate is divided.
  /// @param dt_s  (0, kStepMaxS]
  /// Errors: kInvalidArgument if the motion leaves kSpeedMaxMS or kRateMaxRadS, as with
  /// coefficients that add energy. The state then stays the last one within these limits.
  Status step(const Controls& commands, double dt_s);

  [[nodiscard]] const BodyState& state() const { return state_; }
  [[nodiscard]] const Controls& positions() const { return positions_; }
  [[nodiscard]] const Airframe& airframe() const { return setup_.airframe; }
  [[nodiscard]] const Environment& environment() const { return setup_.environment; }
  /// Velocity of the air around the aircraft relative to world, expressed in world [m/s].
  [[nodiscard]] const Eigen::Vector3d& air_velocity_world_m_s() const { return air_world_m_s_; }
  [[nodiscard]] AirData air_data() const;
  /// What ideal accelerometers measure: acceleration minus gravity, expressed in body [m/s^2].
  [[nodiscard]] Eigen::Vector3d specific_force_body_m_s2() const;
  /// The state as the rest of the program knows it.
  [[nodiscard]] AircraftState truth(std::int64_t t_ns) const;

 private:
  Aircraft(const AircraftSetup& setup, const BodyState& start, const Controls& positions);
  [[nodiscard]] Wrench wrench_at(const BodyState& state, const Controls& positions) const;
  [[nodiscard]] int parts_of(double dt_s) const;
  void meet_gust(double dt_s);

  AircraftSetup setup_;
  RigidBody body_;
  double damping_m2_kg_;  // fastest damping rate over density and speed
  BodyState state_;
  Controls positions_;
  std::optional<Turbulence> turbulence_;
  Eigen::Vector3d air_world_m_s_;
  Eigen::Vector3d air_rate_body_rad_s_ = Eigen::Vector3d::Zero();
};

}  // namespace overfly::dynamics
