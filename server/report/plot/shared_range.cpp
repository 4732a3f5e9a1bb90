#include "server/report/plot/shared_range.hpp"

#include <algorithm>

namespace overfly::server::plot {
namespace {

constexpr double kMostNextToTruth = 100.0;
constexpr double kMostWithoutTruth = 1e4;

bool is_empty(const Range& range) { return range.low > range.high; }

Range union_of(const Range& a, const Range& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

struct Estimate {
  std::string label;
  Range range;
  double span = 0.0;  ///< together with the truth
};

}  // namespace

SharedRange shared_y_range(const std::vector<Series>& series, double least) {
  SharedRange shared{y_range_of({}), {}};
  for (const Series& line : series) {
    if (line.style == 0) shared.range = union_of(shared.range, y_range_of({line}));
  }
  const double most = is_empty(shared.range) ? kMostWithoutTruth : kMostNextToTruth;
  std::vector<Estimate> estimates;
  for (const Series& line : series) {
    const Range range = y_range_of({line});
    if (line.style == 0 || is_empty(range)) continue;
    estimates.push_back({line.label, range, union_of(shared.range, range).span()});
  }
  std::stable_sort(estimates.begin(), estimates.end(), [](const Estimate& a, const Estimate& b) {
    return a.span < b.span;
  });
  for (const Estimate& estimate : estimates) {
    const Range wider = union_of(shared.range, estimate.range);
    const bool diverged =
        !is_empty(shared.range) && wider.span() > most * std::max(shared.range.span(), least);
    if (diverged) {
      shared.beyond.push_back(estimate.label);
    } else {
      shared.range = wider;
    }
  }
  return shared;
}

}  // namespace overfly::server::plot
