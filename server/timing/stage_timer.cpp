#include "server/timing/stage_timer.hpp"

#include <algorithm>
#include <numeric>

#include "core/measure/quantile.hpp"

namespace overfly::server {

nlohmann::json DurationList::summary() const {
  if (ms.empty()) return {{"count", 0}};
  const double total = std::accumulate(ms.begin(), ms.end(), 0.0);
  return {{"count", ms.size()},
          {"total_ms", total},
          {"mean_ms", total / static_cast<double>(ms.size())},
          {"median_ms", quantile(ms, 0.5)},
          {"p95_ms", quantile(ms, 0.95)},
          {"p99_ms", quantile(ms, 0.99)},
          {"max_ms", *std::max_element(ms.begin(), ms.end())}};
}

std::optional<LatencySummary> DurationList::latencies() const {
  if (ms.empty()) return std::nullopt;
  return LatencySummary{quantile(ms, 0.5),
                        quantile(ms, 0.95),
                        quantile(ms, 0.99),
                        *std::max_element(ms.begin(), ms.end())};
}

nlohmann::json StageTimer::summary() const {
  nlohmann::json summary = nlohmann::json::object();
  for (const auto& [stage, durations] : stages_) summary[stage] = durations.summary();
  return summary;
}

}  // namespace overfly::server
