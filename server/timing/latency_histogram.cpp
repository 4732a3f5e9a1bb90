#include "server/timing/latency_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::server {
namespace {

constexpr double kShortestMs = 1e-3;
constexpr double kLongestMs = 1e6;
constexpr double kGrowth = 1.02;

std::size_t class_count() {
  static const auto count =
      static_cast<std::size_t>(std::ceil(std::log(kLongestMs / kShortestMs) / std::log(kGrowth)));
  return count;
}

std::size_t class_of(double ms) {
  if (!(ms > kShortestMs)) return 0;
  const double at = std::log(ms / kShortestMs) / std::log(kGrowth);
  return std::min(static_cast<std::size_t>(at), class_count() - 1);
}

}  // namespace

LatencyHistogram::LatencyHistogram() : counts_(class_count()) {}

void LatencyHistogram::add(double ms) {
  const double counted_ms = std::isfinite(ms) ? std::max(ms, 0.0) : 0.0;
  ++counts_[class_of(std::min(counted_ms, kLongestMs))];
  ++count_;
  max_ms_ = std::max(max_ms_, counted_ms);
}

double LatencyHistogram::quantile_ms(double share) const {
  // Nearest rank, as overfly::quantile.
  const double rank = std::max(1.0, std::ceil(share * static_cast<double>(count_) - 1e-9));
  std::uint64_t below = 0;
  std::size_t at = 0;
  while (static_cast<double>(below + counts_[at]) < rank) below += counts_[at++];
  const double middle_ms =
      kShortestMs * std::pow(kGrowth, static_cast<double>(at)) * 0.5 * (1.0 + kGrowth);
  return std::min(middle_ms, max_ms_);
}

std::optional<LatencySummary> LatencyHistogram::summary() const {
  if (count_ == 0) return std::nullopt;
  return LatencySummary{quantile_ms(0.5), quantile_ms(0.95), quantile_ms(0.99), max_ms_};
}

}  // namespace overfly::server
