// Ids of runs, which are the names of their folders.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace overfly::engine {

/// Makes an empty folder `YYYYMMDD-HHMMSS-SCENARIO-RRRRRR` for a run: UTC, and six random letters
/// and digits (30 bits). That the folder was made here and now makes the id this run's alone,
/// whoever else makes runs in the same place.
/// @param now_ns  Unix time
/// @return the id. Errors: kIo naming the folder.
[[nodiscard]] Result<std::string> reserve_run(const std::filesystem::path& runs_folder,
                                              const std::string& scenario,
                                              std::int64_t now_ns);
/// Whether a name begins as reserve_run's do.
[[nodiscard]] bool is_run_id(const std::string& name);
/// Gives the folder of a run that was never flown back; nothing where it holds anything.
void release_run(const std::filesystem::path& runs_folder, const std::string& id);

}  // namespace overfly::engine
