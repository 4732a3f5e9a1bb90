// Memory of this process.
#pragma once

namespace overfly {

/// Resident memory [1e6 bytes]; 0 if /proc cannot be read.
[[nodiscard]] double resident_memory_mb();

/// Peak resident memory so far [1e6 bytes]; 0 if the system does not report it.
[[nodiscard]] double peak_memory_mb();

}  // namespace overfly
