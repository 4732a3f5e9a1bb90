// Flies a mission: decides what to hold now, and when an item is done.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "flight/autopilot/attitude_control.hpp"
#include "flight/autopilot/energy_control.hpp"
#include "flight/autopilot/mission.hpp"
#include "flight/autopilot/path_guidance.hpp"

namespace overfly::autopilot {

enum class FlightPhase { kTakeOff, kEnRoute, kLoiter, kReturn, kLanding, kFlare, kDone };

[[nodiscard]] const char* name_of(FlightPhase phase);

/// The ground's height under a position (east, north), world frame [m].
using GroundHeight = std::function<double(const Eigen::Vector2d& position_m)>;

/// The demand of an instant.
struct FlightDemand {
  double roll_rad = 0.0;
  EnergyDemand energy;
  /// Set in take-off and flare: the pitch is held instead of the energy's.
  std::optional<double> pitch_rad;
  std::optional<double> throttle;
};

class MissionPilot {
 public:
  /// @param ground  heights above ground count from it
  MissionPilot(const Parameters& parameters, Mission mission, GroundHeight ground);

  /// The first item, with the index `item`, starts at the present position. Changes of speed before
  /// it hold.
  void start(const FlightState& state, std::size_t item = 0);
  /// Goes on with others, at the same place of the mission.
  void set_parameters(const Parameters& parameters);
  [[nodiscard]] FlightDemand update(const FlightState& state, double dt_s);

  [[nodiscard]] FlightPhase phase() const { return phase_; }
  /// Index of the item that is flown; the number of items when the mission is done.
  [[nodiscard]] std::size_t item() const { return index_; }
  /// Distance to the right of the present line, or outside of the circle [m]; 0 in take-off.
  [[nodiscard]] double cross_track_m() const { return cross_track_m_; }

 private:
  void begin_item(const FlightState& state);
  /// @return whether the item is a change of speed
  bool take_speed(std::size_t item);
  /// The present item is the return.
  void place_return();
  [[nodiscard]] double airspeed_m_s() const {
    return set_airspeed_m_s_.value_or(parameters_.airspeed_cruise);
  }
  [[nodiscard]] bool reached(const FlightState& state) const;
  [[nodiscard]] bool heads_for_next(const FlightState& state) const;
  [[nodiscard]] double up_of(const MissionItem& item, const Eigen::Vector2d& at_m) const;
  [[nodiscard]] double turn_lead_m(const FlightState& state) const;
  [[nodiscard]] FlightDemand fly_line(const FlightState& state);
  [[nodiscard]] FlightDemand fly_circle(const FlightState& state, double dt_s);
  [[nodiscard]] FlightDemand climb_out(const FlightState& state) const;
  [[nodiscard]] FlightDemand flare(const FlightState& state) const;
  [[nodiscard]] double roll_for(double acceleration_m_s2, const FlightState& state) const;

  Parameters parameters_;
  Mission mission_;
  GroundHeight ground_;
  PathGuidance guidance_;
  std::size_t index_ = 0;
  FlightPhase phase_ = FlightPhase::kEnRoute;
  std::optional<double> set_airspeed_m_s_;            // by the mission
  Eigen::Vector2d from_m_ = Eigen::Vector2d::Zero();  // start of the line
  double from_height_m_ = 0.0;                        // in the terms of the item's own height
  double heading_rad_ = 0.0;                          // of the take-off
  double circled_rad_ = 0.0;
  double circling_s_ = 0.0;
  double last_bearing_rad_ = 0.0;
  bool captured_ = false;                        // the circle has been reached
  std::optional<double> circled_at_height_rad_;  // when the circle's height was reached
  double cross_track_m_ = 0.0;
};

}  // namespace overfly::autopilot
