// Errors of a run's GPS against its truth.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// The body's true places at a run's frames so far, interpolated linearly: a turn of 1 g between
/// frames 0.1 s apart is off by 12 mm.
class GpsErrors {
 public:
  /// @param origin  of the world frame
  GpsErrors(const RunTimeline& timeline, const Geodetic& origin);

  /// Measured place minus the true one at the time of measurement, world frame (east, north, up)
  /// [m]. Empty without a fix, and between frames that are more than 0.5 s apart.
  [[nodiscard]] std::optional<Eigen::Vector3d> of(const GpsSample& fix) const;

 private:
  LocalFrame world_;
  std::vector<std::int64_t> times_ns_;
  std::vector<Eigen::Vector3d> places_world_m_;
};

}  // namespace overfly::server
