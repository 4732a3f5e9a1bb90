// What a process and its children have used, as /proc tells it.
#pragma once

#include <optional>

#include "vo_bridges/vo_port.hpp"

namespace overfly::process {

/// CPU time (all threads; children that have ended count once they were waited for) and the sum of
/// the peaks of resident memory [1e6 bytes] of a process and its living descendants. The peak is
/// that of its program, not of the fork that it began as, which wait4(2) would tell.
/// Empty when there is no such process, or it has ended.
[[nodiscard]] std::optional<ResourceUse> usage_of(int pid);

}  // namespace overfly::process
