// The autopilot: mission, energy and attitude control in one.
#pragma once

#include "flight/autopilot/attitude_control.hpp"
#include "flight/autopilot/energy_control.hpp"
#include "flight/autopilot/mission_pilot.hpp"

namespace overfly::autopilot {

/// The bank is limited so that the airspeed stays above this multiple of the turn's stall speed.
inline constexpr double kTurnOverStall = 1.1;
/// Largest bank at an airspeed, at least 10 deg: a turn of bank phi stalls at the stall speed over
/// sqrt(cos phi). @param stall_speed_m_s  of level flight
[[nodiscard]] double bank_limit_rad(double stall_speed_m_s, double airspeed_m_s);
/// Rate at which the loops run [Hz].
inline constexpr double kControlRateHz = 100.0;

class Autopilot {
 public:
  Autopilot(const Parameters& parameters,
            const dynamics::Airframe& airframe,
            Mission mission,
            GroundHeight ground);

  /// Takes over in flight, with the mission's item of this index and these positions of the
  /// controls.
  void start(const FlightState& state, const dynamics::Controls& positions, std::size_t item = 0);
  /// The commands of the next 1 / kControlRateHz seconds.
  [[nodiscard]] dynamics::Controls update(const FlightState& state);

  [[nodiscard]] const MissionPilot& pilot() const { return pilot_; }
  [[nodiscard]] const FlightDemand& demand() const { return demand_; }

 private:
  double stall_speed_m_s_;  // at sea level
  MissionPilot pilot_;
  EnergyControl energy_;
  AttitudeControl attitude_;
  FlightDemand demand_;
};

}  // namespace overfly::autopilot
