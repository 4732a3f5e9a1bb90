// What the figures of one flight over time share.
#pragma once

#include <string>
#include <vector>

#include "server/report/plot/line_plot.hpp"
#include "server/report/report_content.hpp"

namespace overfly::server::report {

/// What all figures of one flight have in common.
struct Flight {
  const ReportContent& content;
  const ReportRun& run;
  const std::vector<ReportEntry>& entries;
  std::string id;
};

/// From the start to the last frame [s].
[[nodiscard]] plot::Range flight_range(const Flight& flight);

/// A plot over the time of the flight, with its values in words as its description.
/// @param name  unique among the flight's figures
[[nodiscard]] plot::LinePlot time_plot(const Flight& flight,
                                       const std::string& name,
                                       const std::string& title,
                                       const std::string& y_label,
                                       std::vector<plot::Series> series);

}  // namespace overfly::server::report
