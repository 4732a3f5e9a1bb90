// Reads process information from /proc (proc(5)).
#pragma once

#include <filesystem>
#include <optional>
#include <sstream>
#include <vector>

namespace overfly {

[[nodiscard]] std::filesystem::path proc_folder(int pid);

/// The fields of `stat` starting with the third (the state); empty if there is no such process.
[[nodiscard]] std::optional<std::istringstream> stat_after_name(int pid);

/// Processes whose parent is `pid`, started by any of its threads.
[[nodiscard]] std::vector<int> children_of(int pid);

}  // namespace overfly
