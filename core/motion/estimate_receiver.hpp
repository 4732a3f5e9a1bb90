// Takes an estimate of the flight back to the vehicle that flies it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/motion/pose.hpp"

namespace overfly {

/// An answer of an estimator, placed in the world.
struct PlacedEstimate {
  std::int64_t t_ns = 0;  ///< stamp of the image, by the flight's time
  int map_id = 0;         ///< changes with every new origin and scale
  /// T_world_body; empty while the estimator does not track, or its scale is unknown.
  std::optional<Pose> T_world_body;
};

/// Thread-safe.
class EstimateReceiver {
 public:
  virtual ~EstimateReceiver() = default;

  /// Takes the next answer; does not wait for the vehicle.
  virtual void take(const PlacedEstimate& estimate) = 0;
  /// Ends the sending, before the report.
  virtual void finish() = 0;
  /// What was sent so far and what was left out, for the run's log.
  [[nodiscard]] virtual std::string report() const = 0;
};

}  // namespace overfly
