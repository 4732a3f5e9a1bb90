// Holds height and airspeed with throttle and pitch: total-energy control.
#pragma once

#include "flight/autopilot/flight_state.hpp"
#include "flight/autopilot/parameters.hpp"
#include "flight/dynamics/airframe.hpp"

namespace overfly::autopilot {

struct EnergyDemand {
  double up_m = 0.0;
  double climb_m_s = 0.0;  ///< of the demanded height, known in advance
  double airspeed_m_s = 0.0;
};

inline constexpr double kAlphaShare = 0.85;

/// Throttle holds the sum of potential and kinetic energy, pitch their balance (A. A. Lambregts,
/// "Vertical Flight Path and Speed Control Autopilot Design Using Total Energy Principles", AIAA
/// 83-2239). Rates of climb and acceleration are demanded from the errors over TECS_TIME_CONST and
/// limited to the climb and sink that the airframe can fly. Near the stall the pitch is lowered
/// until the angle of attack is below kAlphaShare of that of the stall.
class EnergyControl {
 public:
  struct Output {
    double throttle = 0.0;
    double pitch_rad = 0.0;
  };

  EnergyControl(const Parameters& parameters, const dynamics::Airframe& airframe);

  /// Goes on with others, at the same throttle.
  void set_parameters(const Parameters& parameters) {
    throttle_integral_ += 0.01 * (parameters_.trim_throttle - parameters.trim_throttle);
    parameters_ = parameters;
  }
  /// Starts from a steady flight.
  void start_from(double throttle, double pitch_rad);
  [[nodiscard]] Output update(const EnergyDemand& demand, const FlightState& state, double dt_s);

 private:
  [[nodiscard]] double turn_alpha_rad(const FlightState& state) const;

  Parameters parameters_;
  double alpha_per_load_m_s2_;  // angle of attack times dynamic pressure per load factor, over rho
  double alpha_max_rad_;
  double throttle_integral_ = 0.0;
  double pitch_integral_rad_ = 0.0;
  double airspeed_m_s_ = 0.0;       // filtered
  double alpha_rad_ = 0.0;          // filtered
  double acceleration_m_s2_ = 0.0;  // of the airspeed, filtered
  bool started_ = false;
};

}  // namespace overfly::autopilot
