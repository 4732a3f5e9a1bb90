// A time series of any length in bounded memory, without losing its spikes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace overfly {

inline constexpr std::size_t kSeriesChannels = 3;

/// Up to kSeriesChannels values of one instant.
struct SeriesPoint {
  std::int64_t t_ns = 0;
  std::array<double, kSeriesChannels> values{};

  [[nodiscard]] bool operator==(const SeriesPoint&) const = default;
};

/// Keeps the samples with the smallest and the largest value of each channel in equal intervals of
/// time. A series with few samples stays complete. The interval begins at 1 ms and doubles when
/// there are too many intervals with samples.
class BoundedSeries {
 public:
  /// @param channels       that count, 1 to kSeriesChannels; the others are only carried along
  /// @param max_intervals  at least 1; at most 2 * channels * max_intervals + 2 points are kept
  BoundedSeries(std::size_t channels, std::size_t max_intervals)
      : channels_(channels), max_intervals_(max_intervals) {}

  /// Times may be in any order. @pre the values are finite
  void add(const SeriesPoint& point);
  /// The samples that were kept, by time; the first and the last one are among them.
  [[nodiscard]] std::vector<SeriesPoint> points() const;
  /// All samples that were added.
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  struct Interval {
    std::int64_t number = 0;  ///< floor(time / width_ns_)
    std::array<SeriesPoint, kSeriesChannels> lowest;
    std::array<SeriesPoint, kSeriesChannels> highest;
  };
  void merge(Interval& into, const Interval& from) const;
  void widen();

  std::size_t channels_;
  std::size_t max_intervals_;
  std::int64_t width_ns_ = 1'000'000;
  std::vector<Interval> intervals_;  ///< those with samples, by number
  SeriesPoint first_;
  SeriesPoint last_;
  std::uint64_t count_ = 0;
};

}  // namespace overfly
