#include "server/report/figures/time_figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "core/measure/quantile.hpp"
#include "core/time.hpp"
#include "server/report/figures/camera_figures.hpp"
#include "server/report/figures/estimate_lines.hpp"
#include "server/report/figures/flight_plots.hpp"
#include "server/report/html_parts.hpp"
#include "server/report/plot/band_plot.hpp"
#include "server/report/plot/line_plot.hpp"
#include "server/report/plot/shared_range.hpp"
#include "server/report/run/words.hpp"

namespace overfly::server::report {
namespace {

using evaluation::AlignmentScore;
using plot::LinePlot;
using plot::Point;
using plot::Range;
using plot::Series;

/// Errors whose sizes differ by more than this are drawn on a logarithmic axis.
constexpr double kLogarithmicFrom = 20.0;

/// Ranges of errors and of heights that count as this large [m].
constexpr double kLeastErrorRangeM = 0.1;
constexpr double kLeastHeightRangeM = 2.0;

/// Leaves estimates far beyond the others out of the axis. @return what the caption says of them
std::string leave_out_far(LinePlot& plot, double least_m) {
  plot.unbounded_from = least_m;
  std::string words;
  for (const std::string& label : plot::shared_y_range(plot.series, least_m).beyond) {
    words += " " + label + " leaves the plot: its values are far larger than the others.";
  }
  return words;
}

/// One line for each entry, of entries that have points.
std::vector<Series> entry_lines(
    const Flight& flight, const std::function<std::vector<Point>(const ReportEntry&)>& points_of) {
  std::vector<Series> lines;
  for (std::size_t i = 0; i < flight.entries.size(); ++i) {
    const ReportEntry& entry = flight.entries[i];
    std::vector<Point> points = points_of(entry);
    if (points.empty()) continue;
    lines.push_back(
        {name_of(*entry.run, *entry.estimate), static_cast<int>(i) + 1, std::move(points)});
  }
  return lines;
}

std::string states_figure(const Flight& flight) {
  plot::BandPlot bands;
  bands.id = flight.id + "-states";
  bands.title = "States of the estimators over time";
  bands.x_label = "time [s]";
  bands.x_range = flight_range(flight);
  for (const ReportEntry& entry : flight.entries) {
    const std::string name = name_of(*entry.run, *entry.estimate);
    bands.rows.push_back({name, state_bands(*entry.run, *entry.estimate)});
    bands.description += name + ": " + outcome_text(entry.metrics().score) + ". ";
  }
  return figure("States.",
                "Where a row is empty the estimator got no frame or gave no answer.",
                plot::svg_of(bands));
}

bool sizes_differ(const Flight& flight) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (const ReportEntry& entry : flight.entries) {
    const AlignmentScore* aligned = entry.aligned(flight.content.alignment);
    if (aligned == nullptr || !(aligned->position_m.rmse > 0.0)) continue;
    low = std::min(low, aligned->position_m.rmse);
    high = std::max(high, aligned->position_m.rmse);
  }
  return high > kLogarithmicFrom * low;
}

std::string position_figure(const Flight& flight) {
  const bool logarithmic = sizes_differ(flight);
  LinePlot plot =
      time_plot(flight,
                "position",
                "Position error over time",
                logarithmic ? "error [m] (log)" : "error [m]",
                entry_lines(flight, [&](const ReportEntry& entry) {
                  const AlignmentScore* aligned = entry.aligned(flight.content.alignment);
                  if (aligned == nullptr) return std::vector<Point>();
                  return matched_over_time(*entry.run, *entry.estimate, aligned->position_errors_m);
                }));
  if (plot.series.empty()) return "";
  plot.area_height_px = 220.0;
  plot.logarithmic = logarithmic;
  plot.from_zero = !logarithmic;
  const std::string far = leave_out_far(plot, kLeastErrorRangeM);
  return figure("Position error.",
                std::string("Distance of the estimate from the truth, aligned by ") +
                    evaluation::to_string(flight.content.alignment) + "." + far,
                plot::svg_of(plot));
}

std::string axis_figure(const Flight& flight,
                        double evaluation::AxisError::*axis,
                        const std::string& name,
                        const std::string& title,
                        const std::string& caption) {
  LinePlot plot = time_plot(
      flight, name, title, name + " [m]", entry_lines(flight, [&](const ReportEntry& entry) {
        std::vector<double> values;
        for (const evaluation::AxisError& error : entry.estimate->axis_errors) {
          values.push_back(error.*axis);
        }
        return matched_over_time(*entry.run, *entry.estimate, values);
      }));
  if (plot.series.empty()) return "";
  plot.levels = {{0.0, ""}};
  plot.area_height_px = 120.0;
  const std::string far = leave_out_far(plot, kLeastErrorRangeM);
  return figure(title + ".", caption + far, plot::svg_of(plot));
}

std::string rotation_figure(const Flight& flight) {
  LinePlot plot = time_plot(
      flight,
      "rotation",
      "Rotation error over time",
      "error [deg]",
      entry_lines(flight, [&](const ReportEntry& entry) {
        const AlignmentScore* aligned = entry.aligned(flight.content.alignment);
        if (aligned == nullptr || aligned->degenerate) return std::vector<Point>();
        return matched_over_time(*entry.run, *entry.estimate, aligned->rotation_errors_deg);
      }));
  if (plot.series.empty()) return "";
  plot.from_zero = true;
  return figure("Rotation error.",
                "Geodesic angle between the estimated and the true rotation.",
                plot::svg_of(plot));
}

/// A quantity of the body's pose.
struct PoseQuantity {
  const char* name;
  const char* title;
  const char* y_label;
  const char* caption;
  PoseValue value;
  bool attitude = true;
  std::optional<double> period{};  ///< of an angle that goes round
};

/// Truth and estimates.
std::string pose_figure(const Flight& flight, const PoseQuantity& quantity) {
  std::vector<Series> series{{"truth", 0, truth_over_time(flight.run, quantity.value)}};
  for (Series& line : entry_lines(flight, [&](const ReportEntry& entry) {
         const AlignmentScore* aligned = entry.aligned(flight.content.alignment);
         // A path that does not determine the rotation gives no attitude.
         if (aligned == nullptr || (quantity.attitude && aligned->degenerate)) {
           return std::vector<Point>();
         }
         return estimate_over_time(*entry.run, *entry.estimate, quantity.value);
       })) {
    series.push_back(std::move(line));
  }
  if (quantity.period) {
    for (Series& line : series) {
      line.points = plot::with_gaps_at_wraps(line.points, *quantity.period);
    }
  }
  LinePlot plot =
      time_plot(flight, quantity.name, quantity.title, quantity.y_label, std::move(series));
  plot.area_height_px = 120.0;
  std::string caption = quantity.caption;
  if (!quantity.attitude) caption += leave_out_far(plot, kLeastHeightRangeM);
  return figure(std::string(quantity.title) + ".", caption, plot::svg_of(plot));
}

std::string pose_figures(const Flight& flight) {
  const PoseQuantity quantities[] = {
      {"height",
       "Height",
       "up [m]",
       "Of the body above the origin of the world frame.",
       height_m,
       false},
      {"roll", "Roll", "roll [deg]", "Positive: right wing down.", roll_deg, true, 360.0},
      {"pitch", "Pitch", "pitch [deg]", "Positive: nose up.", pitch_deg},
      {"yaw", "Yaw", "yaw [deg]", "Clockwise from north.", yaw_deg, true, 360.0}};
  std::string markup;
  for (const PoseQuantity& quantity : quantities) markup += pose_figure(flight, quantity);
  return markup;
}

std::string latency_figure(const Flight& flight) {
  LinePlot plot = time_plot(flight,
                            "latency",
                            "Latency over time",
                            "latency [ms]",
                            entry_lines(flight, [](const ReportEntry& entry) {
                              return latency_over_time(*entry.run, *entry.estimate);
                            }));
  if (plot.series.empty()) return "";
  std::vector<double> all;
  for (const Series& line : plot.series) {
    for (const Point& point : line.points) {
      if (!point.is_gap()) all.push_back(point.y);
    }
  }
  plot.logarithmic = quantile(all, 1.0) > kLogarithmicFrom * quantile(all, 0.01);
  if (plot.logarithmic) plot.y_label += " (log)";
  plot.from_zero = !plot.logarithmic;
  plot.area_height_px = 140.0;
  return figure("Latency.", "Time from sending a frame to its answer.", plot::svg_of(plot));
}

}  // namespace

std::string time_figures(const ReportContent& content,
                         const ReportRun& run,
                         const std::vector<ReportEntry>& entries,
                         const std::string& id) {
  const Flight flight{content, run, entries, id};
  using evaluation::AxisError;
  std::string markup = entries.empty() ? "" : states_figure(flight);
  markup += position_figure(flight);
  markup += axis_figure(flight,
                        &AxisError::along_m,
                        "along",
                        "Error along the path",
                        "Positive: ahead of the truth.");
  markup += axis_figure(flight,
                        &AxisError::across_m,
                        "across",
                        "Error across the path",
                        "Positive: to the right of the truth.");
  markup +=
      axis_figure(flight, &AxisError::up_m, "up", "Error in height", "Positive: above the truth.");
  markup += rotation_figure(flight);
  markup += pose_figures(flight);
  markup += latency_figure(flight);
  markup += camera_figures(flight);
  return markup;
}

}  // namespace overfly::server::report
