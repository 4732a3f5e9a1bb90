#include "server/timing/stage_timer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace overfly::engine {
namespace {

/// Nearest-rank quantile of sorted values.
double quantile(const std::vector<double>& sorted, double share) {
  const auto rank =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)));
  return sorted[rank];
}

}  // namespace

nlohmann::json DurationList::summary() const {
  if (ms.empty()) return {{"count", 0}};
  std::vector<double> sorted = ms;
  std::sort(sorted.begin(), sorted.end());
  const double total = std::accumulate(sorted.begin(), sorted.end(), 0.0);
  return {{"count", sorted.size()},
          {"total_ms", total},
          {"mean_ms", total / static_cast<double>(sorted.size())},
          {"median_ms", quantile(sorted, 0.5)},
          {"p95_ms", quantile(sorted, 0.95)},
          {"p99_ms", quantile(sorted, 0.99)},
          {"max_ms", sorted.back()}};
}

std::optional<LatencySummary> DurationList::latencies() const {
  if (ms.empty()) return std::nullopt;
  std::vector<double> sorted = ms;
  std::sort(sorted.begin(), sorted.end());
  return LatencySummary{
      quantile(sorted, 0.5), quantile(sorted, 0.95), quantile(sorted, 0.99), sorted.back()};
}

nlohmann::json StageTimer::summary() const {
  nlohmann::json summary = nlohmann::json::object();
  for (const auto& [stage, durations] : stages_) summary[stage] = durations.summary();
  return summary;
}

}  // namespace overfly::engine
