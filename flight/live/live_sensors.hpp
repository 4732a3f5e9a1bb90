// Samples of the sensors that a live vehicle carries, until a run has taken them.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "core/sensors/sensor_samples.hpp"
#include "flight/mavlink/sensor_messages.hpp"

namespace overfly::flight::live {

/// The samples of one sensor from the best of the vehicle's messages that have it.
template <typename Sample>
struct SensorTrack {
  int preference = std::numeric_limits<int>::max();  ///< of the message; the lower, the better
  std::string message;                               ///< its name
  std::deque<Sample> waiting;                        ///< available_ns strictly increasing
  std::int64_t last_measured_ns = std::numeric_limits<std::int64_t>::min();
  bool taken = false;  ///< some samples: the message is no longer changed
  std::int64_t first_taken_ns = 0;
  std::int64_t last_taken_ns = std::numeric_limits<std::int64_t>::min();  ///< available_ns
  std::uint64_t count = 0;                                                ///< taken
};

/// Collects the samples of a vehicle's messages. Each sensor has one message: the best that came
/// before its first sample was taken, so that nothing is measured twice. Messages that come late
/// are put in order; what comes after later samples were taken is counted and left out. Not
/// thread-safe.
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
  void forget_before(std::int64_t t_ns);
  /// The samples since the last call that were measured from `start_ns` on and known up to `t_ns`,
  /// with times that count from `start_ns`. All are times of the vehicle's clock.
  [[nodiscard]] SensorSamples take_until(std::int64_t t_ns, std::int64_t start_ns);

  /// "sensors of the vehicle: imu from HIGHRES_IMU (50.0 Hz), ...; not sent: range". Empty if
  /// nothing was taken.
  [[nodiscard]] std::string report() const;

 private:
  double geoid_separation_m_;
  std::uint8_t autopilot_;
  std::uint64_t left_out_ = 0;
  std::tuple<SensorTrack<ImuSample>,
             SensorTrack<BarometerSample>,
             SensorTrack<GpsSample>,
             SensorTrack<AirspeedSample>,
             SensorTrack<MagnetometerSample>,
             SensorTrack<RangeSample>>
      tracks_;
};

}  // namespace overfly::flight::live
