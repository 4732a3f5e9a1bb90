// What Linux tells of a process in its folder below /proc (proc(5)).
#pragma once

#include <filesystem>
#include <optional>
#include <sstream>

namespace overfly::process {

[[nodiscard]] std::filesystem::path proc_folder(int pid);

/// The fields of `stat` from the third (the state) on; empty when there is no such process.
[[nodiscard]] std::optional<std::istringstream> stat_after_name(int pid);

}  // namespace overfly::process
