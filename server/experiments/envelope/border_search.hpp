// Finds the border of survival in a grid with few flights, by bisection.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/result.hpp"

namespace overfly::server::experiments {

/// A line of the grid: all values of one axis, with the other axes fixed.
struct GridLine {
  std::vector<std::size_t> at;  ///< index of the value of each other axis
};

struct GridPlace {
  std::size_t line = 0;
  std::size_t value = 0;  ///< index along the axis
  [[nodiscard]] auto operator<=>(const GridPlace&) const = default;
};

/// The border on one line, as indices along the axis.
struct LineBorder {
  std::optional<std::size_t> survives;  ///< last place that survives; empty = none does
  std::optional<std::size_t> fails;     ///< first place that fails next to it; empty = none does
  /// What was flown is not divided by one border.
  bool irregular = false;
};

struct Borders {
  std::vector<LineBorder> lines;  ///< as given
  std::size_t asked = 0;          ///< places whose outcome was needed
};

/// Whether each place survives. Called with one or two places that were not asked before.
using AskPlaces = std::function<Result<std::vector<bool>>(const std::vector<GridPlace>&)>;

/// Finds the border on every line, where along a line survival ends, or begins, once. The first
/// line is bisected. On each further one the two places at the border of the nearest line are asked
/// first; if both have the same outcome, steps of doubled length lead to the border, which is then
/// bisected. A smooth border needs two places of a line, whatever their number. On a line whose
/// outcomes change more than once, one of the changes is found; it is marked if that was noticed.
/// @param values  number of places of a line, at least 1
/// Errors: those of `ask`.
[[nodiscard]] Result<Borders> find_borders(const std::vector<GridLine>& lines,
                                           std::size_t values,
                                           const AskPlaces& ask);

}  // namespace overfly::server::experiments
