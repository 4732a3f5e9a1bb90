// The sensors of the aircraft whose log is flown.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "core/sensors/sample_source.hpp"
#include "flight/logs/flight_log.hpp"

namespace overfly::flight {

/// Samples of each sensor that are held: 2.7 hours at 400 Hz. The oldest of more are left out.
inline constexpr std::size_t kMaxLoggedSamples = 4'000'000;

struct SensorRequest {
  std::string source;         ///< stream of the flight's positions: sensors of its vehicle are read
  std::uint32_t boot = 0;     ///< the run of its clock that is flown, as LoggedTruth::boot
  std::int64_t begin_ns = 0;  ///< by the vehicle's clock: the flight's time 0
  std::int64_t end_ns = 0;
  double geoid_separation_m = 0.0;  ///< added to the GPS's heights above mean sea level
  bool moved = false;               ///< flown elsewhere: only the IMU and the airspeed still hold
};

/// Reads the samples of a part of a log. Of several messages or records with samples of one sensor,
/// the best is taken.
/// Errors: as read_log_into.
[[nodiscard]] Result<std::unique_ptr<SampleSource>> read_logged_sensors(
    const logs::OpenedLog& log, const SensorRequest& request, const std::atomic<bool>* cancel);

}  // namespace overfly::flight
