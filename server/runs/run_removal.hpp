// Deletes run folders.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace overfly::server {

/// Deletes a run's folder. It is renamed first, so that no one sees a part of it and only one of
/// several simultaneous calls succeeds. Symbolic links are deleted, not followed.
/// Errors: kNotFound if it does not exist (any more); kConflict while a process uses it; kIo naming
/// the file that cannot be deleted.
[[nodiscard]] Status remove_run_folder(const std::filesystem::path& folder);

/// The first step of it, which is quick: no list shows the folder any more, and its name is free.
/// @return where it lies now, to be deleted with everything in it
/// Errors: as above
[[nodiscard]] Result<std::filesystem::path> put_run_folder_aside(
    const std::filesystem::path& folder);

/// Deletes what killed programs have left in a folder of runs: folders renamed for deletion, and
/// empty folders of queued runs that were never flown (after a day).
void remove_leftovers(const std::filesystem::path& runs_folder);

}  // namespace overfly::server
