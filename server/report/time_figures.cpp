#include "server/report/time_figures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "core/measure/quantile.hpp"
#include "core/time.hpp"
#include "server/report/estimate_lines.hpp"
#include "server/report/html_parts.hpp"
#include "server/report/plot/band_plot.hpp"
#include "server/report/plot/line_plot.hpp"
#include "server/report/words.hpp"

namespace overfly::server::report {
namespace {

using evaluation::AlignmentScore;
using plot::LinePlot;
using plot::Point;
using plot::Range;
using plot::Series;

/// Errors whose sizes differ by more than this are drawn on a logarithmic axis.
constexpr double kLogarithmicFrom = 20.0;
constexpr double kTexturedFrom = 0.5;

/// What all figures of one flight have in common.
struct Flight {
  const ReportContent& content;
  const ReportRun& run;
  const std::vector<ReportEntry>& entries;
  std::string id;
};

Range flight_range(const Flight& flight) {
  const std::vector<FrameRow>& frames = flight.run.main_frames();
  return {std::min(0.0, s_from_ns(frames.front().t_ns)), s_from_ns(frames.back().t_ns)};
}

/// "orb 0.1 to 3.2, at the end 3.1" of each line.
std::string values_in_words(const std::vector<Series>& series) {
  std::string text;
  for (const Series& line : series) {
    const Range range = plot::y_range_of({line});
    const auto last = std::find_if(line.points.rbegin(),
                                   line.points.rend(),
                                   [](const Point& point) { return !point.is_gap(); });
    text += text.empty() ? "" : "; ";
    text += line.label + ": ";
    if (last == line.points.rend()) {
      text += "no values";
    } else {
      text += figure_text(range.low) + " to " + figure_text(range.high) + ", at the end " +
              figure_text(last->y);
    }
  }
  return text + ".";
}

LinePlot time_plot(const Flight& flight,
                   const std::string& name,
                   const std::string& title,
                   const std::string& y_label,
                   std::vector<Series> series) {
  LinePlot plot;
  plot.id = flight.id + "-" + name;
  plot.title = title;
  plot.description = y_label + " over time. " + values_in_words(series);
  plot.x_label = "time [s]";
  plot.y_label = y_label;
  plot.x_range = flight_range(flight);
  plot.series = std::move(series);
  return plot;
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
  return figure("Position error.",
                std::string("Distance of the estimate from the truth, aligned by ") +
                    evaluation::to_string(flight.content.alignment) + ".",
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
  return figure(title + ".", caption, plot::svg_of(plot));
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
  return figure(std::string(quantity.title) + ".", quantity.caption, plot::svg_of(plot));
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
                        "Positive: ahead of the truth. A growing error is one of scale.");
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
  markup += texture_figure(flight);
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
