// Resources used by this process so far.
#pragma once

#include <vector>

namespace overfly::renderer {

/// CPU time of all threads [ms].
[[nodiscard]] double process_cpu_ms();
/// CPU time of the calling thread [ms].
[[nodiscard]] double thread_cpu_ms();
/// Resident memory [MB]; 0 if /proc cannot be read.
[[nodiscard]] double resident_mb();

/// The smallest value that at least `share` of the values do not exceed; 0 if there are none.
/// @param share  in (0, 1]
[[nodiscard]] double quantile(std::vector<double> values, double share);

}  // namespace overfly::renderer
