// Where an axis has its ticks, and what they say.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace overfly::server::plot {

struct Range {
  double low = 0.0;
  double high = 1.0;
  [[nodiscard]] double span() const { return high - low; }
};

/// A range that can be drawn: [0, 1] if it is empty or not finite, and room around a single value.
[[nodiscard]] Range usable(const Range& range);
/// A part of the span more on both sides.
[[nodiscard]] Range padded_by(const Range& range, double share);

struct Ticks {
  std::vector<double> values;  ///< increasing, in the range
  /// That all of them need; empty: each as many as it needs itself.
  std::optional<int> decimals;
};

/// Multiples of 1, 2 or 5 times a power of ten in the usable range: the finest of these steps with
/// at most `most` ticks. @pre most >= 2
[[nodiscard]] Ticks nice_ticks(const Range& range, int most);
/// 1, 2 and 5 times powers of ten, or only powers if the former are too many; of many powers every
/// second, third, ... @pre range.low > 0
[[nodiscard]] Ticks log_ticks(const Range& range, int most);
/// With a minus sign (U+2212), and a power of ten where the digits would not fit.
[[nodiscard]] std::string tick_text(double value, const Ticks& ticks);

/// The largest 1, 2 or 5 times a power of ten that does not exceed `limit`. @pre limit > 0
[[nodiscard]] double nice_below(double limit);

}  // namespace overfly::server::plot
