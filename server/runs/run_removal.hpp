// How run folders are deleted.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace overfly::engine {

/// Deletes a run's folder. It is renamed aside first, so that nobody sees a part of it, and of
/// several who delete it at the same time one succeeds. Links are deleted, not followed.
/// Errors: kNotFound where it is not there (any more); kConflict while a process is at work in it;
/// kIo naming what cannot be deleted.
[[nodiscard]] Status remove_run_folder(const std::filesystem::path& folder);

/// Deletes what programs that were killed have left in a folder of runs: folders renamed aside, and
/// empty folders of runs that waited and were never flown (after a day).
void remove_leftovers(const std::filesystem::path& runs_folder);

}  // namespace overfly::engine
