// The autopilot: mission, energy and attitude control in one.
#pragma once

#include "flight/autopilot/attitude_control.hpp"
#include "flight/autopilot/energy_control.hpp"
#include "flight/autopilot/mission_pilot.hpp"
#include "flight/dynamics/environment.hpp"

namespace overfly::autopilot {

/// The bank is limited so that the airspeed stays above this multiple of the turn's stall speed.
inline constexpr double kTurnOverStall = 1.1;
/// Largest bank at an airspeed, at least 10 deg: a turn of bank phi stalls at the stall speed over
/// sqrt(cos phi). @param stall_speed_m_s  of level flight
[[nodiscard]] double bank_limit_rad(double stall_speed_m_s, double airspeed_m_s);
/// The airspeed at which level flight stalls, which grows with height as the air gets thinner.
class StallSpeed {
 public:
  StallSpeed(const dynamics::Airframe& airframe, const dynamics::Environment& environment);
  [[nodiscard]] double at_m_s(double up_m) const;

 private:
  dynamics::Environment environment_;
  double at_origin_m_s_;
};
/// Rate at which the loops run [Hz].
inline constexpr double kControlRateHz = 100.0;

class Autopilot {
 public:
  Autopilot(const Parameters& parameters,
            const dynamics::Airframe& airframe,
            const dynamics::Environment& environment,
            Mission mission,
            GroundHeight ground);

  /// Takes over in flight, with the mission's item of this index and these positions of the
  /// controls.
  void start(const FlightState& state, const dynamics::Controls& positions, std::size_t item = 0);
  /// Goes on with others from where mission and loops are.
  void set_parameters(const Parameters& parameters, const dynamics::Airframe& airframe);
  /// The commands of the next 1 / kControlRateHz seconds.
  [[nodiscard]] dynamics::Controls update(const FlightState& state);

  [[nodiscard]] const MissionPilot& pilot() const { return pilot_; }
  [[nodiscard]] const FlightDemand& demand() const { return demand_; }

 private:
  StallSpeed stall_speed_;
  MissionPilot pilot_;
  EnergyControl energy_;
  AttitudeControl attitude_;
  FlightDemand demand_;
};

}  // namespace overfly::autopilot
