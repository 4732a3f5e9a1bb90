// A plot of lines as inline SVG. Colours and dashes are classes of the page's style sheet.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/report/plot/series.hpp"
#include "server/report/plot/ticks.hpp"

namespace overfly::server::plot {

/// A horizontal line across the plot.
struct Level {
  double value = 0.0;
  std::string label;
};

/// A named place.
struct Marker {
  Point place;
  std::string label;
};

struct LinePlot {
  std::string id;           ///< unique in the page, of letters, digits and '-'
  std::string title;        ///< for readers that do not see the plot
  std::string description;  ///< likewise: what the plot shows
  std::string x_label;      ///< with the unit
  std::string y_label;
  std::vector<Series> series;
  std::vector<Level> levels;
  std::vector<Marker> markers;
  std::optional<Range> x_range;  ///< default: of the series
  std::optional<Range> y_range;  ///< default: of the series and levels, with a margin
  double width_px = 900.0;
  double area_height_px = 170.0;  ///< between the axes
  bool from_zero = false;         ///< the y axis begins at 0
  /// An estimate that diverges reaches any value: ranges of y leave it out (shared_y_range). Ranges
  /// below this one count as this large.
  std::optional<double> unbounded_from;
  /// y, over at most five powers of ten. Values that are not positive become gaps.
  bool logarithmic = false;
  bool legend = true;
  /// The data URI of a picture that fills the area between the axes; lines get an outline.
  std::string background_uri;
  /// A map: x is east and y is north [m], with a scale bar and a north arrow. The caller chooses
  /// ranges and area so that both axes have one scale.
  bool map = false;
};

/// Width of the area between the axes of a plot of this width.
[[nodiscard]] double area_width_px(double plot_width_px);

/// Series of more than kMaxPoints points are decimated.
[[nodiscard]] std::string svg_of(const LinePlot& plot);

}  // namespace overfly::server::plot
