// The cameras' part of a run's metrics.
#pragma once

#include <cstdint>
#include <vector>

#include "server/record/run_records.hpp"
#include "server/scoring/run_metrics.hpp"

namespace overfly::server {

/// The runs of consecutive numbers among ascending frame numbers.
[[nodiscard]] std::vector<FrameRange> ranges_of(const std::vector<std::int64_t>& frames);

[[nodiscard]] CameraMetrics camera_metrics_from(const CameraRecords& camera);

}  // namespace overfly::server
