#include "server/report/figures/flight_plots.hpp"

#include <algorithm>
#include <utility>

#include "core/time.hpp"
#include "server/report/run/words.hpp"

namespace overfly::server::report {
namespace {

using plot::LinePlot;
using plot::Point;
using plot::Range;
using plot::Series;

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

}  // namespace

Range flight_range(const Flight& flight) {
  const std::vector<FrameRow>& frames = flight.run.main_frames();
  return {std::min(0.0, s_from_ns(frames.front().t_ns)), s_from_ns(frames.back().t_ns)};
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

}  // namespace overfly::server::report
