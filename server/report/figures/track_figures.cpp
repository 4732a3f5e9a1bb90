#include "server/report/figures/track_figures.hpp"

#include <algorithm>
#include <cmath>

#include "core/text/percent.hpp"
#include "server/report/figures/estimate_lines.hpp"
#include "server/report/figures/map_picture.hpp"
#include "server/report/html_parts.hpp"
#include "server/report/plot/line_plot.hpp"
#include "server/report/run/words.hpp"

namespace overfly::server::report {
namespace {

using plot::LinePlot;
using plot::Point;
using plot::Range;
using plot::Series;

constexpr double kMapWidthPx = 900.0;
constexpr double kSideWidthPx = 446.0;
constexpr double kSideHeightPx = 170.0;
constexpr double kLeastSpanM = 50.0;
constexpr double kLeastHeightM = 10.0;
/// Height of a map, as a share of its width.
constexpr double kFlattest = 0.45;
constexpr double kSteepest = 0.85;
constexpr int kPictureWidthPx = 1280;

constexpr int kEast = 0;
constexpr int kNorth = 1;
constexpr int kUp = 2;

std::vector<Series> paths_of(const ReportRun& run,
                             const std::vector<ReportEntry>& entries,
                             int x,
                             int y) {
  std::vector<Series> paths{{"truth", 0, truth_path(run, x, y)}};
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const ReportEntry& entry = entries[i];
    paths.push_back({name_of(*entry.run, *entry.estimate),
                     static_cast<int>(i) + 1,
                     estimate_path(*entry.run, *entry.estimate, x, y)});
  }
  return paths;
}

void widen(Range& range, double span) {
  const double lacking = span - range.span();
  if (lacking > 0.0) range = {range.low - 0.5 * lacking, range.high + 0.5 * lacking};
}

/// The shown range of one axis: that of the truth, extended to the estimates by `flight_m` at most.
Range shown_range(const Range& truth, const Range& all, double flight_m, double least_m) {
  if (!(truth.low <= truth.high)) return plot::usable(truth);
  Range range{std::max(std::min(all.low, truth.low), truth.low - flight_m),
              std::min(std::max(all.high, truth.high), truth.high + flight_m)};
  widen(range, least_m);
  return plot::usable(plot::padded_by(range, 0.08));
}

struct Extent {
  Range x;
  Range y;
};

/// The shown ranges of a pair of axes: estimates are shown up to one size of the flight outside the
/// truth.
Extent shown_extent(const std::vector<Series>& paths) {
  const std::vector<Series> truth(paths.begin(), paths.begin() + 1);
  const Range x = plot::x_range_of(truth);
  const Range y = plot::y_range_of(truth);
  const double flight_m = std::max({kLeastSpanM, x.span(), y.span()});
  return {shown_range(x, plot::x_range_of(paths), flight_m, kLeastSpanM),
          shown_range(y, plot::y_range_of(paths), flight_m, kLeastSpanM)};
}

/// Share of the points that lie outside.
double share_outside(const std::vector<Point>& points, const Extent& extent) {
  std::size_t all = 0;
  std::size_t outside = 0;
  for (const Point& point : points) {
    if (point.is_gap()) continue;
    ++all;
    const bool inside = point.x >= extent.x.low && point.x <= extent.x.high &&
                        point.y >= extent.y.low && point.y <= extent.y.high;
    outside += inside ? 0 : 1;
  }
  return all == 0 ? 0.0 : static_cast<double>(outside) / static_cast<double>(all);
}

/// Says which tracks leave the picture, and which are not there.
std::string absence_words(const std::vector<Series>& paths, const Extent& extent) {
  std::string text;
  for (std::size_t i = 1; i < paths.size(); ++i) {
    if (paths[i].points.empty()) {
      text += " " + paths[i].label + " has no track.";
      continue;
    }
    const double outside = share_outside(paths[i].points, extent);
    if (outside > 0.0) {
      text += " " + percent_text(outside) + " of the poses of " + paths[i].label +
              " lie outside the picture.";
    }
  }
  return text;
}

std::string size_words(const Extent& extent) {
  return figure_text(extent.x.span()) + " m by " + figure_text(extent.y.span()) + " m";
}

Result<std::string> map_figure(const ReportContent& content,
                               const ReportRun& run,
                               const std::vector<ReportEntry>& entries,
                               const std::string& id,
                               const MapOptions& options) {
  LinePlot map;
  map.id = id + "-map";
  map.title = "Map of the tracks";
  map.x_label = "east [m]";
  map.y_label = "north [m]";
  map.map = true;
  map.series = paths_of(run, entries, kEast, kNorth);
  Extent extent = shown_extent(map.series);
  widen(extent.y, kFlattest * extent.x.span());
  widen(extent.x, extent.y.span() / kSteepest);
  const double aspect = extent.y.span() / extent.x.span();
  map.width_px = kMapWidthPx;
  map.area_height_px = plot::area_width_px(kMapWidthPx) * aspect;
  map.x_range = extent.x;
  map.y_range = extent.y;
  const std::vector<Point>& truth = map.series.front().points;
  if (!truth.empty()) map.markers = {{truth.front(), "start"}};
  map.description = "North is up; " + size_words(extent) + "." + absence_words(map.series, extent);

  const Result<MapPicture> ground =
      map_picture(run,
                  {extent.x.low, extent.x.high, extent.y.low, extent.y.high},
                  kPictureWidthPx,
                  std::max(1, static_cast<int>(std::lround(kPictureWidthPx * aspect))),
                  options);
  if (!ground) return ground.error();
  map.background_uri = ground->data_uri;
  std::string caption = "Truth and estimates, the latter aligned by " +
                        std::string(evaluation::to_string(content.alignment)) +
                        "; axes of the world frame." + absence_words(map.series, extent);
  if (!ground->note.empty()) caption += " " + ground->note;
  if (!ground->data_uri.empty()) {
    caption += " Imagery: " +
               (ground->attribution.empty() ? "no attribution given" : ground->attribution) + ".";
  }
  return figure("Map.", caption, plot::svg_of(map));
}

std::string side_view(const ReportRun& run,
                      const std::vector<ReportEntry>& entries,
                      int axis,
                      const std::string& id) {
  const bool east = axis == kEast;
  LinePlot side;
  side.id = id + (east ? "-xz" : "-yz");
  side.title = east ? "Tracks seen from the south" : "Tracks seen from the east";
  side.x_label = east ? "east [m]" : "north [m]";
  side.y_label = "up [m]";
  side.width_px = kSideWidthPx;
  side.area_height_px = kSideHeightPx;
  side.series = paths_of(run, entries, axis, kUp);
  Extent extent = shown_extent(side.series);
  // Heights are drawn larger: estimates may leave the truth's range by its own size.
  const std::vector<Series> truth(side.series.begin(), side.series.begin() + 1);
  const Range up = plot::y_range_of(truth);
  extent.y = shown_range(
      up, plot::y_range_of(side.series), std::max(kLeastHeightM, up.span()), kLeastHeightM);
  side.x_range = extent.x;
  side.y_range = extent.y;
  side.description =
      size_words(extent) + "; heights are exaggerated." + absence_words(side.series, extent);
  return figure(east ? "East and up (XZ)." : "North and up (YZ).",
                "Heights exaggerated." + absence_words(side.series, extent),
                plot::svg_of(side));
}

}  // namespace

Result<std::string> track_figures(const ReportContent& content,
                                  const ReportRun& run,
                                  const std::vector<ReportEntry>& entries,
                                  const std::string& id,
                                  const MapOptions& options) {
  Result<std::string> map = map_figure(content, run, entries, id, options);
  if (!map) return map.error();
  return *map + "<div class=\"pair\">\n" + side_view(run, entries, kEast, id) +
         side_view(run, entries, kNorth, id) + "</div>\n";
}

}  // namespace overfly::server::report
