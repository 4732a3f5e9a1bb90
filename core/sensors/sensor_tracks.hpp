// Samples of an aircraft's sensors on their way from messages or records to a run.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <string>
#include <tuple>

#include "core/sensors/sensor_samples.hpp"

namespace overfly {

/// The samples of one sensor from the best of its sources.
template <typename Sample>
struct SensorTrack {
  int preference = std::numeric_limits<int>::max();  ///< of the source; the lower, the better
  std::string source;
  std::deque<Sample> waiting;  ///< available_ns strictly increasing
  std::int64_t last_measured_ns = std::numeric_limits<std::int64_t>::min();
  bool taken = false;  ///< some samples of this source
  std::int64_t first_taken_ns = 0;
  std::int64_t last_taken_ns = std::numeric_limits<std::int64_t>::min();  ///< available_ns
  std::uint64_t count = 0;                                                ///< taken
};

/// Holds samples until they are taken. Each sensor has one source: the best that came within a
/// second of the first sample taken. The times of samples taken increase, whatever their source.
/// Samples that come late are put in order; what comes after later samples were taken is counted
/// and left out, as are the oldest of too many. Not thread-safe.
class SensorTracks {
 public:
  /// @param max_waiting  samples of each sensor
  explicit SensorTracks(std::size_t max_waiting) : max_waiting_(max_waiting) {}

  /// @param preference  of the source; the lower, the better
  void add(int preference, const std::string& source, const SensorSamples& samples);
  /// Forgets samples measured before a time.
  void forget_before(std::int64_t t_ns);
  /// The samples since the last call that were measured from `start_ns` on and available at
  /// `t_ns`, with times that count from `start_ns`. Both are times of the samples' clock.
  [[nodiscard]] SensorSamples take_until(std::int64_t t_ns, std::int64_t start_ns);

  /// "imu from HIGHRES_IMU (50.0 Hz), ...; not sent: range". Empty if nothing was taken.
  /// @param missing  "not sent"
  [[nodiscard]] std::string report(const std::string& missing) const;

 private:
  std::size_t max_waiting_;
  std::uint64_t left_out_ = 0;
  std::tuple<SensorTrack<ImuSample>,
             SensorTrack<BarometerSample>,
             SensorTrack<GpsSample>,
             SensorTrack<AirspeedSample>,
             SensorTrack<MagnetometerSample>,
             SensorTrack<RangeSample>>
      tracks_;
};

}  // namespace overfly
