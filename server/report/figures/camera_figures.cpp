#include "server/report/figures/camera_figures.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "server/report/figures/estimate_lines.hpp"
#include "server/report/html_parts.hpp"
#include "server/report/plot/line_plot.hpp"

namespace overfly::server::report {
namespace {

using plot::LinePlot;
using plot::Point;
using plot::Series;

constexpr double kTexturedFrom = 0.5;

/// The same quantity of several runs of one flight is one line.
void add_new_line(std::vector<Series>& series, Series line) {
  const auto same = [&](const Series& other) {
    return std::equal(other.points.begin(),
                      other.points.end(),
                      line.points.begin(),
                      line.points.end(),
                      [](const Point& a, const Point& b) {
                        return a.x == b.x && (a.y == b.y || (a.is_gap() && b.is_gap()));
                      });
  };
  if (line.points.empty() || std::any_of(series.begin(), series.end(), same)) return;
  line.style = static_cast<int>(series.size()) + 1;
  series.push_back(std::move(line));
}

/// A quantity of the frames of all cameras of the flight's runs.
std::vector<Series> camera_lines(
    const Flight& flight,
    const std::string& what,
    const std::function<std::optional<double>(const FrameRow&)>& value) {
  std::vector<const ReportRun*> runs;
  for (const ReportEntry& entry : flight.entries) {
    if (runs.empty() || runs.back() != entry.run) runs.push_back(entry.run);
  }
  if (runs.empty()) runs.push_back(&flight.run);
  std::vector<Series> series;
  for (const ReportRun* run : runs) {
    for (std::size_t i = 0; i < run->cameras.size(); ++i) {
      std::string label = run->cameras[i].name.empty() ? "camera" : run->cameras[i].name;
      if (!run->label.empty()) label = run->label + ": " + label;
      add_new_line(series, {label + ", " + what, 0, frames_over_time(*run, i, value)});
    }
  }
  return series;
}

std::string texture_figure(const Flight& flight) {
  const auto imaged = [](double FrameRow::*value) {
    return [value](const FrameRow& row) {
      const bool seen = row.texels_per_pixel_median > 0.0;
      return seen ? std::optional<double>(row.*value) : std::nullopt;
    };
  };
  std::vector<Series> series =
      camera_lines(flight, "median", imaged(&FrameRow::texels_per_pixel_median));
  for (Series& line : camera_lines(flight, "least", imaged(&FrameRow::texels_per_pixel_min))) {
    add_new_line(series, std::move(line));
  }
  if (series.empty()) return "";
  LinePlot plot = time_plot(
      flight, "texture", "Texture of the ground over time", "texels per pixel", std::move(series));
  plot.levels = {{kTexturedFrom, "0.5: below, the imagery limits the result"}};
  plot.from_zero = true;
  plot.area_height_px = 140.0;
  return figure("Texture.",
                "Linear texels of the finest imagery per pixel of the camera, in each frame.",
                plot::svg_of(plot));
}

std::string share_figure(const Flight& flight,
                         double FrameRow::*share,
                         const std::string& name,
                         const std::string& title,
                         const std::string& caption) {
  std::vector<Series> series = camera_lines(
      flight, name, [&](const FrameRow& row) { return std::optional<double>(100.0 * row.*share); });
  if (!(plot::y_range_of(series).high > 0.0)) return "";
  LinePlot plot = time_plot(flight, name, title + " over time", name + " [%]", std::move(series));
  plot.from_zero = true;
  plot.area_height_px = 100.0;
  return figure(title + ".", caption, plot::svg_of(plot));
}

}  // namespace

std::string camera_figures(const Flight& flight) {
  std::string markup = texture_figure(flight);
  markup += share_figure(
      flight, &FrameRow::void_fraction, "void", "Ground without imagery", "Share of the image.");
  markup += share_figure(flight,
                         &FrameRow::saturated_fraction,
                         "saturated",
                         "Saturated pixels",
                         "Share of the image.");
  return markup;
}

}  // namespace overfly::server::report
