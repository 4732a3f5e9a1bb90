// Resource use of a process and its children, from /proc.
#pragma once

#include <optional>

#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// CPU time (all threads; ended children count after they were waited for) and the sum of the peaks
/// of resident memory [1e6 bytes] of a process and its living descendants. The peak is that of its
/// program, not of the initial fork that wait4(2) would report.
/// Empty if there is no such process or it has ended.
[[nodiscard]] std::optional<ResourceUse> usage_of(int pid);

}  // namespace overfly
