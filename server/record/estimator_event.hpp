#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/image.hpp"
#include "server/record/estimator_status.hpp"
#include "server/record/rows/rows.hpp"

namespace overfly::server {

/// Result of one frame: an answer, or a drop (record.dropped).
struct EstimatorEvent {
  EstimateRecord record;
  double latency_ms = 0.0;  ///< from sending the frame to the answer
  std::optional<Image> debug_image;
  std::vector<Eigen::Vector3f> map_points_vo;
  std::map<std::string, double> timing_ms;
  /// Total so far; not set in every event.
  std::optional<EstimatorUse> use;
};

}  // namespace overfly::server
