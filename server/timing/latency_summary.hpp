#pragma once

namespace overfly::server {

/// Time from sending a frame to its answer.
struct LatencySummary {
  double median_ms = 0.0;
  double p95_ms = 0.0;
  double p99_ms = 0.0;
  double max_ms = 0.0;
};

}  // namespace overfly::server
