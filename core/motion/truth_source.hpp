// Interface to the flight's truth: a simulator, a log or a live autopilot.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/estimate_receiver.hpp"
#include "core/motion/flight_event.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"

namespace overfly {

class SampleSource;

/// The aircraft at one instant.
struct AircraftState {
  std::int64_t t_ns = 0;
  Pose T_world_body;  ///< body = forward-right-down
  /// Velocity of body relative to world, expressed in world [m/s].
  Eigen::Vector3d v_body_world_m_s = Eigen::Vector3d::Zero();
  /// Angular rate of body relative to world, expressed in body [rad/s].
  Eigen::Vector3d omega_body_rad_s = Eigen::Vector3d::Zero();
  double airspeed_m_s = 0.0;
};

/// The state at a time between a and b: position and velocity by the cubic Hermite polynomial of
/// both ends' positions and velocities, rotation by SLERP, the rest linear.
/// @pre a.t_ns < b.t_ns
[[nodiscard]] AircraftState interpolate(const AircraftState& a,
                                        const AircraftState& b,
                                        std::int64_t t_ns);

/// A flight. Times of queries must not decrease; a live source may block until the state is known.
class TruthSource {
 public:
  virtual ~TruthSource() = default;

  /// The state at time t >= 0 from the start of the run; empty after the end of the flight.
  /// @param cancel  ends a wait for the state; may be null
  /// Errors: kCancelled; any failure of the source.
  [[nodiscard]] Result<std::optional<AircraftState>> state_at(
      std::int64_t t_ns, const std::atomic<bool>* cancel = nullptr) {
    return find_state(t_ns, cancel);
  }
  /// Empty if the end of the flight is not known in advance.
  [[nodiscard]] virtual std::optional<std::int64_t> duration_ns() const = 0;
  /// One line for the manifest that describes the flight ("course: 25 m/s, 45 deg/s, 300 m").
  [[nodiscard]] virtual std::string description() const = 0;
  /// t = 0 by the clock of the log or file that is flown [ns]; empty if it has none.
  [[nodiscard]] virtual std::optional<std::int64_t> log_start_ns() const { return std::nullopt; }
  /// Lines of the flight's file that were dropped or moved. Empty if none.
  [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }
  /// Called before the first state is asked for, once a flight in real time is ready: a live flight
  /// then begins with the latest state instead of the one with which it was opened.
  virtual void begin() {}
  /// Events up to `t_ns` that were not taken before, by time. @param t_ns  must not decrease
  [[nodiscard]] virtual std::vector<FlightEvent> take_events(std::int64_t /*t_ns*/) { return {}; }
  /// What a live vehicle says of itself, twice a second of the flight; empty in between, and of
  /// other flights.
  [[nodiscard]] virtual std::optional<VehicleStatus> take_status(std::int64_t /*t_ns*/) {
    return std::nullopt;
  }
  /// The sensors of the aircraft that flies, until the flight goes; null for flights without.
  [[nodiscard]] virtual SampleSource* sample_source() { return nullptr; }
  /// Takes estimates back to the vehicle that flies; null if it wants none.
  [[nodiscard]] virtual std::shared_ptr<EstimateReceiver> estimate_receiver() const {
    return nullptr;
  }
  /// Of a live source: when the message arrived with which the latest state became known [ns of the
  /// machine's steady clock].
  [[nodiscard]] virtual std::optional<std::int64_t> heard_ns() const { return std::nullopt; }

 private:
  /// As state_at.
  [[nodiscard]] virtual Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* cancel) = 0;
};

}  // namespace overfly
