#include "server/report/plot/line_plot.hpp"

#include <algorithm>
#include <cmath>

#include "server/report/plot/markup.hpp"
#include "server/report/plot/shared_range.hpp"
#include "server/report/plot/svg_parts.hpp"

namespace overfly::server::plot {
namespace {

constexpr double kLeftPx = 66.0;
constexpr double kRightPx = 16.0;
constexpr double kBelowPx = 40.0;
constexpr double kTickPx = 5.0;
constexpr double kMarginShare = 0.06;
/// Of a logarithmic axis; smaller values lie below it.
constexpr double kMostDecades = 5.0;
/// Powers of ten that such an axis may reach: all of them are doubles.
constexpr double kMostPower = 280.0;
/// Share of a map's width that its scale bar may take.
constexpr double kScaleBarShare = 0.25;

/// The area between the axes, and where values lie in it.
struct Area {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
  Range x;
  Range y;  ///< logarithms for a logarithmic axis
  bool logarithmic = false;

  [[nodiscard]] double px_x(double value) const {
    return left + width * (value - x.low) / x.span();
  }
  [[nodiscard]] double px_y(double value) const {
    const double at = logarithmic ? std::log10(value) : value;
    return top + height * (1.0 - (at - y.low) / y.span());
  }
};

/// Of the style sheet: s0 is the truth, s1 to s12 are estimates.
std::string style_class(int style) {
  return "s" + std::to_string(style <= 0 ? 0 : (style - 1) % kEstimateStyles + 1);
}

std::string rectangle(const Area& area) {
  return " x=\"" + attribute_number(area.left) + "\" y=\"" + attribute_number(area.top) +
         "\" width=\"" + attribute_number(area.width) + "\" height=\"" +
         attribute_number(area.height) + "\"";
}

std::vector<Series> drawn_series(const LinePlot& plot) {
  std::vector<Series> series;
  for (const Series& line : plot.series) {
    series.push_back({line.label, line.style, decimated(line.points)});
    if (!plot.logarithmic) continue;
    for (Point& point : series.back().points) {
      if (!(point.y > 0.0)) point.y = kGap;
    }
  }
  return series;
}

Range y_range_for(const LinePlot& plot, const std::vector<Series>& series) {
  if (plot.y_range) return usable(*plot.y_range);
  Range range =
      plot.unbounded_from ? shared_y_range(series, *plot.unbounded_from).range : y_range_of(series);
  for (const Level& level : plot.levels) {
    range.low = std::min(range.low, level.value);
    range.high = std::max(range.high, level.value);
  }
  if (plot.logarithmic) {
    if (!(range.low > 0.0) || !std::isfinite(range.high)) return {0.0, 1.0};
    const double high = std::clamp(std::log10(range.high), -kMostPower, kMostPower);
    const double low = std::clamp(std::log10(range.low), high - kMostDecades, high);
    return padded_by(usable({low, high}), kMarginShare);
  }
  if (plot.from_zero) range.low = std::min(range.low, 0.0);
  range = usable(range);
  if (!plot.from_zero) return padded_by(range, kMarginShare);
  return {range.low, range.high + kMarginShare * range.span()};
}

std::string path_of(const std::vector<Point>& points, const Area& area) {
  std::string path;
  bool begun = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].is_gap()) {
      begun = false;
      continue;
    }
    path += begun ? 'L' : 'M';
    path +=
        attribute_number(area.px_x(points[i].x)) + " " + attribute_number(area.px_y(points[i].y));
    const bool alone = !begun && (i + 1 == points.size() || points[i + 1].is_gap());
    if (alone) path += "h0";  // a dot, by the round line ends
    begun = true;
  }
  return path;
}

/// All outlines lie below all lines: they hide no other line.
std::string lines_of(const std::vector<Series>& series, const Area& area, bool outlined) {
  std::string outlines;
  std::string lines;
  for (const Series& line : series) {
    const std::string path = path_of(line.points, area);
    if (path.empty()) continue;
    if (outlined) outlines += "<path class=\"line halo\" d=\"" + path + "\"/>\n";
    lines += "<path class=\"line " + style_class(line.style) + "\" d=\"" + path + "\"/>\n";
  }
  return outlines + lines;
}

std::string axes_of(const LinePlot& plot, const Area& area) {
  std::string markup;
  const double bottom = area.top + area.height;
  const Ticks x_ticks = nice_ticks(area.x, std::max(2, static_cast<int>(area.width / 80.0)));
  for (const double value : x_ticks.values) {
    const double x = area.px_x(value);
    markup += svg_line(x, area.top, x, bottom, "grid");
    markup += svg_line(x, bottom, x, bottom + kTickPx, "axis");
    markup += svg_text(x, bottom + 18.0, "middle", "tick", tick_text(value, x_ticks));
  }
  const int most = std::max(2, static_cast<int>(area.height / 26.0));
  const Ticks y_ticks =
      area.logarithmic ? log_ticks({std::pow(10.0, area.y.low), std::pow(10.0, area.y.high)}, most)
                       : nice_ticks(area.y, most);
  for (const double value : y_ticks.values) {
    const double y = area.px_y(value);
    markup += svg_line(area.left, y, area.left + area.width, y, "grid");
    markup += svg_line(area.left - kTickPx, y, area.left, y, "axis");
    markup += svg_text(area.left - 8.0, y + 4.0, "end", "tick", tick_text(value, y_ticks));
  }
  markup += svg_text(area.left + 0.5 * area.width, bottom + 35.0, "middle", "label", plot.x_label);
  const std::string middle = attribute_number(area.top + 0.5 * area.height);
  markup += "<text class=\"label\" x=\"13\" y=\"" + middle +
            "\" text-anchor=\"middle\" transform=\"rotate(-90 13 " + middle + ")\">" +
            escaped(plot.y_label) + "</text>\n";
  return markup;
}

std::string levels_of(const LinePlot& plot, const Area& area) {
  std::string markup;
  for (const Level& level : plot.levels) {
    const double y = area.px_y(level.value);
    markup += svg_line(area.left, y, area.left + area.width, y, "level");
    markup += svg_text(area.left + area.width - 6.0, y - 4.0, "end", "level-text", level.label);
  }
  return markup;
}

std::string markers_of(const LinePlot& plot, const Area& area) {
  std::string markup;
  for (const Marker& marker : plot.markers) {
    if (marker.place.is_gap()) continue;
    const double x = area.px_x(marker.place.x);
    const double y = area.px_y(marker.place.y);
    markup += "<circle class=\"marker\" cx=\"" + attribute_number(x) + "\" cy=\"" +
              attribute_number(y) + "\" r=\"5\"/>\n";
    const bool right = x < area.left + 0.8 * area.width;
    markup += svg_text(
        x + (right ? 9.0 : -9.0), y - 6.0, right ? "start" : "end", "on-map", marker.label);
  }
  return markup;
}

std::string map_signs(const Area& area) {
  const double length_m = nice_below(kScaleBarShare * area.x.span());
  const double length_px = area.width * length_m / area.x.span();
  const double x = area.left + 14.0;
  const double y = area.top + area.height - 14.0;
  const std::string bar = "M" + attribute_number(x) + " " + attribute_number(y - 7.0) + "v7h" +
                          attribute_number(length_px) + "v-7";
  const bool km = length_m >= 1000.0;
  const std::string length =
      attribute_number(km ? length_m / 1000.0 : length_m, 6) + (km ? " km" : " m");
  const double north_x = area.left + area.width - 24.0;
  const std::string tip = "M" + attribute_number(north_x) + " " + attribute_number(area.top + 12.0);
  return "<path class=\"bar-halo\" d=\"" + bar + "\"/>\n<path class=\"bar\" d=\"" + bar + "\"/>\n" +
         svg_text(x + 0.5 * length_px, y - 6.0, "middle", "on-map", length) +
         "<path class=\"north\" d=\"" + tip + "l8 24l-8 -6l-8 6z\"/>\n" +
         svg_text(north_x, area.top + 51.0, "middle", "on-map", "N");
}

std::vector<LegendEntry> legend_entries(const LinePlot& plot) {
  std::vector<LegendEntry> entries;
  for (const Series& line : plot.series) {
    entries.push_back({"line " + style_class(line.style), line.label});
  }
  return entries;
}

}  // namespace

double area_width_px(double plot_width_px) { return plot_width_px - kLeftPx - kRightPx; }

std::string svg_of(const LinePlot& plot) {
  const std::vector<Series> series = drawn_series(plot);
  const Legend legend =
      plot.legend ? legend_of(legend_entries(plot), kLeftPx, plot.width_px - kRightPx) : Legend{};
  Area area;
  area.left = kLeftPx;
  area.top = legend.height_px + 6.0;
  area.width = area_width_px(plot.width_px);
  area.height = plot.area_height_px;
  area.x = usable(plot.x_range.value_or(x_range_of(series)));
  area.y = usable(y_range_for(plot, series));
  area.logarithmic = plot.logarithmic;

  const std::string clip = plot.id + "-c";
  const std::string frame = rectangle(area);
  std::string svg = svg_head(
      plot.id, plot.title, plot.description, plot.width_px, area.top + area.height + kBelowPx);
  svg += "<clipPath id=\"" + clip + "\"><rect" + frame + "/></clipPath>\n" + legend.markup;
  const bool pictured = !plot.background_uri.empty();
  svg += axes_of(plot, area);
  if (pictured) {
    svg +=
        "<image" + frame + " preserveAspectRatio=\"none\" href=\"" + plot.background_uri + "\"/>\n";
  }
  svg += "<g clip-path=\"url(#" + clip + ")\"" + (pictured ? " class=\"pictured\"" : "") + ">\n" +
         levels_of(plot, area) + lines_of(series, area, pictured) + markers_of(plot, area) +
         (plot.map ? map_signs(area) : "") + "</g>\n";
  return svg + "<rect class=\"frame\"" + frame + "/>\n</svg>\n";
}

}  // namespace overfly::server::plot
