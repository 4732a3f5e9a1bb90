// Which runs of a report flew the same flight, so that their estimates can be compared.
#pragma once

#include <cstddef>
#include <vector>

#include "server/report/run/report_run.hpp"

namespace overfly::server::report {

/// True if both have the same origin of the world, last equally long (to 0.5 s), and their bodies
/// are at the same places (to 0.1 m) at the same times. Decided by what was flown, not by the
/// scenarios: runs of other estimators, cameras or parameters compare.
[[nodiscard]] bool same_flight(const ReportRun& a, const ReportRun& b);

/// Indices of runs with the same flight, in the order of the first of each.
[[nodiscard]] std::vector<std::vector<std::size_t>> flight_groups(
    const std::vector<ReportRun>& runs);

}  // namespace overfly::server::report
