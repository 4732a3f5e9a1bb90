// States over time as bands, one row for each estimator, as inline SVG.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "server/report/plot/ticks.hpp"

namespace overfly::server::plot {

/// In the order of severity. They differ in height as well as in colour.
enum class BandKind { kNone, kTracking, kInitialising, kLost };

struct Band {
  double from = 0.0;
  double to = 0.0;
  BandKind kind = BandKind::kNone;
};

struct BandRow {
  std::string label;
  std::vector<Band> bands;  ///< in order, without overlaps
};

struct BandPlot {
  std::string id;
  std::string title;
  std::string description;
  std::string x_label;
  Range x_range;
  std::vector<BandRow> rows;
  double width_px = 900.0;
};

/// The most bands of a row.
inline constexpr std::size_t kMaxBands = 1000;

/// Neighbouring bands of one kind joined. If they are still more than `most`, the range is cut into
/// so many columns, each of which shows the worst state in it: no loss disappears.
[[nodiscard]] std::vector<Band> joined_bands(const std::vector<Band>& bands,
                                             const Range& range,
                                             std::size_t most = kMaxBands);

[[nodiscard]] std::string svg_of(const BandPlot& plot);

}  // namespace overfly::server::plot
