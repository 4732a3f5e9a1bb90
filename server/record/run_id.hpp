// Run ids, which are also the names of the run folders.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace overfly::server {

/// Creates an empty folder `YYYYMMDD-HHMMSS-SCENARIO-RRRRRR` for a run: UTC, and six random letters
/// and digits (30 bits). Because the folder is created here, the id is unique even if other
/// programs create runs in the same place.
/// @param now_ns  Unix time
/// @return the id
/// Errors: kIo naming the folder.
[[nodiscard]] Result<std::string> reserve_run(const std::filesystem::path& runs_folder,
                                              const std::string& scenario,
                                              std::int64_t now_ns);
/// Whether a name begins like an id from reserve_run.
[[nodiscard]] bool is_run_id(const std::string& name);
/// Removes the folder of a run that was never flown; keeps it if it is not empty.
void release_run(const std::filesystem::path& runs_folder, const std::string& id);

}  // namespace overfly::server
