#include "core/measure/bounded_series.hpp"

#include <algorithm>

namespace overfly {
namespace {

std::int64_t floor_of_ratio(std::int64_t t_ns, std::int64_t width_ns) {
  const std::int64_t quotient = t_ns / width_ns;
  return t_ns % width_ns < 0 ? quotient - 1 : quotient;
}

}  // namespace

void BoundedSeries::add(const SeriesPoint& point) {
  if (count_ == 0 || point.t_ns < first_.t_ns) first_ = point;
  if (count_ == 0 || point.t_ns >= last_.t_ns) last_ = point;
  ++count_;
  Interval added;
  added.number = floor_of_ratio(point.t_ns, width_ns_);
  added.lowest.fill(point);
  added.highest.fill(point);
  if (intervals_.empty() || intervals_.back().number < added.number) {
    intervals_.push_back(added);
  } else {
    const auto place = std::lower_bound(
        intervals_.begin(), intervals_.end(), added.number, [](const Interval& a, std::int64_t b) {
          return a.number < b;
        });
    if (place->number == added.number) {
      merge(*place, added);
    } else {
      intervals_.insert(place, added);
    }
  }
  while (intervals_.size() > max_intervals_) widen();
}

void BoundedSeries::merge(Interval& into, const Interval& from) const {
  for (std::size_t i = 0; i < channels_; ++i) {
    if (from.lowest[i].values[i] < into.lowest[i].values[i]) into.lowest[i] = from.lowest[i];
    if (from.highest[i].values[i] > into.highest[i].values[i]) into.highest[i] = from.highest[i];
  }
}

void BoundedSeries::widen() {
  width_ns_ *= 2;
  std::vector<Interval> merged;
  merged.reserve(intervals_.size());
  for (Interval& interval : intervals_) {
    interval.number = floor_of_ratio(interval.number, 2);
    if (!merged.empty() && merged.back().number == interval.number) {
      merge(merged.back(), interval);
    } else {
      merged.push_back(interval);
    }
  }
  intervals_ = std::move(merged);
}

std::vector<SeriesPoint> BoundedSeries::points() const {
  if (count_ == 0) return {};
  std::vector<SeriesPoint> points{first_};
  for (const Interval& interval : intervals_) {
    for (std::size_t i = 0; i < channels_; ++i) {
      points.push_back(interval.lowest[i]);
      points.push_back(interval.highest[i]);
    }
  }
  points.push_back(last_);
  std::stable_sort(points.begin(), points.end(), [](const SeriesPoint& a, const SeriesPoint& b) {
    return a.t_ns < b.t_ns;
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace overfly
