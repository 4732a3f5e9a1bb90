// Samples of the sensors that a live vehicle carries, until a run has taken them.
#pragma once

#include <cstdint>
#include <string>

#include "core/sensors/sensor_tracks.hpp"
#include "flight/mavlink/sensor_messages.hpp"

namespace overfly::flight::live {

/// Collects the samples of a vehicle's messages, as SensorTracks. Not thread-safe.
class LiveSensors {
 public:
  /// Of a sensor; the oldest ones are left out, and counted: 80 minutes at 100 Hz.
  static constexpr std::size_t kMaxWaiting = 500'000;

  /// @param autopilot  MAV_AUTOPILOT of the vehicle until its next heartbeat; 0: not known
  explicit LiveSensors(double geoid_separation_m, std::uint8_t autopilot = 0)
      : geoid_separation_m_(geoid_separation_m), autopilot_(autopilot) {}

  /// @param latest_ns  of the vehicle's clock
  void take(const mavlink::Frame& frame, std::int64_t latest_ns);
  /// Forgets samples measured before the flight.
  void forget_before(std::int64_t t_ns) { tracks_.forget_before(t_ns); }
  /// The samples since the last call that were measured from `start_ns` on and known up to `t_ns`,
  /// with times that count from `start_ns`. All are times of the vehicle's clock.
  [[nodiscard]] SensorSamples take_until(std::int64_t t_ns, std::int64_t start_ns) {
    return tracks_.take_until(t_ns, start_ns);
  }

  /// "sensors of the vehicle: imu from HIGHRES_IMU (50.0 Hz), ...; not sent: range". Empty if
  /// nothing was taken.
  [[nodiscard]] std::string report() const;

 private:
  double geoid_separation_m_;
  std::uint8_t autopilot_;
  SensorTracks tracks_{kMaxWaiting};
};

}  // namespace overfly::flight::live
