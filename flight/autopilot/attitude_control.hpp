// Holds demanded roll and pitch angles with ailerons, elevator and rudder.
#pragma once

#include "flight/autopilot/flight_state.hpp"
#include "flight/autopilot/parameters.hpp"
#include "flight/dynamics/actuators.hpp"

namespace overfly::autopilot {

struct AttitudeDemand {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
};

/// Two nested loops for each axis: an angle error over a time constant demands a rate, limited to
/// RLL2SRV_RMAX or PTCH2SRV_RMAX_UP, _DN; feed-forward, proportional and integral gains turn the
/// rate into a deflection. Gains follow the airspeed: feed-forward with 1/V, the others with 1/V^2,
/// as a surface's moment grows with V^2 and the damping with V. In a turn, the pitch and yaw rates
/// of coordinated flight, g tan(roll) / V about the vertical, are added to the demands. The rudder
/// damps the yaw rate and removes the side force. Proportional and integral gains act on the
/// difference from the rate that the airframe reaches with the feed-forward alone, so that its lag
/// does not count as an error.
class AttitudeControl {
 public:
  AttitudeControl(const Parameters& parameters, const dynamics::Airframe& airframe);

  /// Goes on with others.
  void set_parameters(const Parameters& parameters, const dynamics::Airframe& airframe);
  /// Starts from deflections that hold the present flight.
  void start_from(const dynamics::Controls& positions);
  /// The deflections of the next dt_s; the throttle is 0.
  [[nodiscard]] dynamics::Controls update(const AttitudeDemand& demand,
                                          const FlightState& state,
                                          double dt_s);

 private:
  struct RateLoop {
    double forward, proportional, integral;  // shares of the range
    double range_rad;                        // the larger one of the two directions
    double lowest, highest;                  // shares of the range
    double actuator_lag_s, response_s;       // of the airframe to its surface
    double held = 0.0;                       // integral, share of the range
    double behind_actuator_rad_s = 0.0, expected_rad_s = 0.0;

    /// Takes over the state of a loop with other gains.
    void go_on_from(const RateLoop& before);
    [[nodiscard]] double update(double speed_ratio,
                                double demand_rad_s,
                                double rate_rad_s,
                                double dt_s);
  };

  Parameters parameters_;
  RateLoop roll_, pitch_;
  double rudder_range_rad_;
  double yaw_held_ = 0.0;  // share of the range
};

}  // namespace overfly::autopilot
