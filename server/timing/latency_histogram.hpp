// Percentiles of a stream of durations in bounded memory.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/timing/latency_summary.hpp"

namespace overfly::server {

/// Counts durations in classes whose bounds grow by 2 % from 1 us to 1000 s; values beyond these
/// bounds count in the first or last class. A percentile is the middle of its class, at most 1 %
/// off the nearest-rank percentile; the maximum is exact. Adding takes constant time.
class LatencyHistogram {
 public:
  LatencyHistogram();

  /// @param ms  negative or non-finite values count as 0
  void add(double ms);
  /// Empty without durations.
  [[nodiscard]] std::optional<LatencySummary> summary() const;

 private:
  [[nodiscard]] double quantile_ms(double share) const;

  std::vector<std::uint32_t> counts_;
  std::uint64_t count_ = 0;
  double max_ms_ = 0.0;
};

}  // namespace overfly::server
