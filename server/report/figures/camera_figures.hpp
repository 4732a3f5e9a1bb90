// Quantities of the camera's frames over time: texture, imagery, saturation.
#pragma once

#include <string>

#include "server/report/figures/flight_plots.hpp"

namespace overfly::server::report {

/// Of all cameras of the runs, equal lines once; ground without imagery and saturated pixels only
/// where there are any. @return HTML
[[nodiscard]] std::string camera_figures(const Flight& flight);

}  // namespace overfly::server::report
