// A simulated aircraft with its autopilot that speaks MAVLink as a vehicle does.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/earth/height_query.hpp"
#include "core/result.hpp"
#include "flight/autopilot/autopilot.hpp"
#include "flight/autopilot/mission_items.hpp"
#include "flight/vehicle/message_schedule.hpp"
#include "flight/vehicle/mission_store.hpp"
#include "flight/vehicle/parameter_store.hpp"
#include "flight/vehicle/send.hpp"
#include "flight/vehicle/vehicle_report.hpp"

namespace overfly::vehicle {

struct VehicleSetup {
  dynamics::Airframe airframe;
  double airspeed_m_s = 25.0;  ///< cruise; the autopilot is tuned for it
  Geodetic home;               ///< on flat ground; its height counts as above mean sea level
  double heading_rad = 0.0;
  Eigen::Vector3d wind_world_m_s = Eigen::Vector3d::Zero();
  std::optional<dynamics::TurbulenceLevel> turbulence;
  std::uint64_t seed = 0;
  std::uint8_t system = 1;
};

/// Behaves as ArduPlane in its simulator, as far as ground stations need it: heartbeat, state, GPS,
/// parameters, missions, commands (arm, mode, mission start, message rates, reposition), time sync.
/// Modes: AUTO, RTL, LOITER, GUIDED; on the ground also MANUAL.
///
/// The aircraft stands at home until it is armed and a mission that begins with a take-off starts.
/// It lands where its mission lands, disarms there, and takes off again from there. After the last
/// item of another mission it returns. Contact with the ground elsewhere, and a forced disarm in
/// flight, is a crash: it disarms, stands on the ground below, and says so.
///
/// Time is the vehicle's own and moves with step(). Equal messages at equal times give equal
/// flights.
class SimulatedVehicle {
 public:
  /// Period of step() [ns].
  static constexpr std::int64_t kStepNs =
      static_cast<std::int64_t>(1e9 / autopilot::kControlRateHz);

  /// Errors: as autopilot::tuned_for.
  static Result<std::unique_ptr<SimulatedVehicle>> create(const VehicleSetup& setup);

  /// Takes a message of a ground station. Messages to other systems are ignored.
  void take(const flight::mavlink::Frame& frame, const Send& send);
  /// Moves the vehicle on by kStepNs and sends what is due.
  void step(const Send& send);

  [[nodiscard]] VehicleReport report() const;
  [[nodiscard]] const VehicleSetup& setup() const { return setup_; }
  /// VISION_POSITION_ESTIMATE, ODOMETRY and GPS_INPUT so far: they do not change the flight.
  [[nodiscard]] std::uint64_t received_estimates() const { return received_estimates_; }

 private:
  using MessageId = flight::mavlink::MessageId;
  using Frame = flight::mavlink::Frame;

  SimulatedVehicle(const VehicleSetup& setup, const autopilot::Parameters& parameters);
  void take_command(const Frame& frame, const Send& send);
  [[nodiscard]] std::uint8_t run(std::uint16_t command,
                                 const Frame& frame,
                                 std::uint8_t system,
                                 const Send& send);
  [[nodiscard]] std::uint8_t arm(bool wanted, bool forced, const Send& send);
  [[nodiscard]] std::uint8_t change_mode(Mode mode, const Send& send);
  [[nodiscard]] std::uint8_t reposition(const Frame& frame, const Send& send);
  /// The flight of an upload from this vehicle's home. @pre not empty
  [[nodiscard]] Result<autopilot::PlannedMission> plan(MissionStore::Items items) const;
  [[nodiscard]] Status check_mission(const MissionStore::Items& items) const;
  /// Starts the flight by the mission from an item, from the ground or in flight.
  [[nodiscard]] Status fly_mission(std::size_t item);
  /// Circles around a place at a height above home.
  void circle(const Eigen::Vector3d& centre_m);
  void follow(autopilot::Mission mission, std::size_t item);
  /// Flies for kStepNs. Errors: as dynamics::Aircraft::step.
  [[nodiscard]] Status move(const dynamics::Controls& commands);
  void finish_flight(const Send& send);
  void park(const std::string& text, Severity severity, const Send& send);
  void say(const std::string& text, Severity severity, const Send& send);

  VehicleSetup setup_;
  ParameterStore parameters_;
  LocalFrame frame_;
  Eigen::Vector3d field_ned_ut_;  ///< the earth's magnetic field at home
  FlatGround ground_{0.0};
  MissionStore missions_;
  std::int64_t now_ns_ = 0;
  Mode mode_ = Mode::kManual;
  bool armed_ = false;
  Eigen::Vector3d parked_m_ = Eigen::Vector3d::Zero();
  double parked_heading_rad_ = 0.0;
  std::optional<dynamics::Aircraft> aircraft_;  // in flight
  std::optional<autopilot::Autopilot> autopilot_;
  autopilot::Mission flown_;
  std::size_t resume_item_ = 0;
  std::uint64_t flights_ = 0;
  MessageSchedule schedule_;
  std::uint16_t text_number_ = 0;
  std::uint64_t received_estimates_ = 0;
};

}  // namespace overfly::vehicle
