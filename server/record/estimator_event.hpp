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
  /// From sending the frame to the answer; of a frame that waited because it was made ahead of
  /// time, from when the estimator took it.
  double latency_ms = 0.0;
  std::optional<Image> debug_image;
  std::vector<Eigen::Vector3f> map_points_vo;
  std::map<std::string, double> timing_ms;
  /// Total so far; not set in every event.
  std::optional<EstimatorUse> use;
  /// Log lines of the estimator and notes about it up to this answer, where frames are made ahead.
  std::vector<std::string> log;
};

}  // namespace overfly::server
