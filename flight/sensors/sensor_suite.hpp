// All sensors of an aircraft, measuring while it flies.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "core/motion/truth_source.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "flight/sensors/air_sensors.hpp"
#include "flight/sensors/gps.hpp"
#include "flight/sensors/imu.hpp"
#include "flight/sensors/magnetometer.hpp"
#include "flight/sensors/range_finder.hpp"

namespace overfly::flight {

/// The seed of the IMU's errors in a suite with this seed.
[[nodiscard]] std::uint64_t imu_seed(std::uint64_t suite_seed);

/// Each sensor has its own clock and its own random numbers: fitting one more changes no other.
/// Memory depends on the time between calls of take_until(), not on the length of the flight.
class SensorSuite {
 public:
  struct Options {
    SensorModels models;
    SensorPlace place;
    double gravity_m_s2 = 9.80665;  ///< magnitude
    std::vector<TimeSpan> gps_outages;
    std::uint64_t seed = 1;
  };
  /// @pre the models are valid
  explicit SensorSuite(Options options);
  ~SensorSuite();
  SensorSuite(SensorSuite&& other) noexcept;
  SensorSuite& operator=(SensorSuite&& other) noexcept;

  /// The next time at which the state is needed.
  [[nodiscard]] std::int64_t next_ns() const;
  /// Measures the state at next_ns().
  void take(const AircraftState& state);
  /// The samples that have become available up to a time since the last call: those of the IMU at
  /// the ends of their intervals, those of the GPS when they are delivered, all others when they
  /// are measured.
  [[nodiscard]] SensorSamples take_until(std::int64_t t_ns);

 private:
  struct Sensors;
  std::unique_ptr<Sensors> sensors_;
};

/// Passes a flight on. Before a state is passed on, the suite has measured the flight up to its
/// time.
/// @param suite  must outlive the result
[[nodiscard]] std::unique_ptr<TruthSource> sensed_while_flown(std::unique_ptr<TruthSource> flight,
                                                              SensorSuite& suite);

}  // namespace overfly::flight
