// What smoothing leaves of a log's samples, for viewers.
#pragma once

#include <atomic>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/smoothing/smooth_motion.hpp"

namespace overfly::server {

struct ResidualRequest {
  std::string source;  ///< as flight::logs::choose_truth
  flight::logs::LogSlice slice;
  std::optional<double> time_offset_s = 0.0;  ///< of the attitudes; empty: estimated
  std::size_t max_points = 6000;              ///< of each table
};

/// Smooths a log and returns the samples minus the smooth motion, in bounded size with their
/// extremes (docs/PROTOCOL.md).
/// Errors: as flight::smooth_log.
[[nodiscard]] Result<nlohmann::json> log_residuals(
    const flight::logs::OpenedLog& log,
    const ResidualRequest& request,
    const std::atomic<bool>* cancel,
    const flight::smoothing::SmoothingProgress& progress);

}  // namespace overfly::server
