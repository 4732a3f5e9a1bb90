// The sweeps in a folder, and how far they are, for clients of a server.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"

namespace overfly::server::experiments {

/// Checks that a folder can become, or is, that of a sweep: it has a sweep.json, or nothing but
/// what a sweep makes before that, or it is empty or absent. Errors: kConflict naming a file that
/// is of something else, also of a hunt.
[[nodiscard]] Status check_sweep_folder(const std::filesystem::path& folder);
/// Checks that a folder can become, or is, that of a hunt: it has a hunt.json or the record of a
/// study, or it is empty or absent. Errors: as above; kConflict for the folder of a sweep.
[[nodiscard]] Status check_hunt_folder(const std::filesystem::path& folder);

/// {"sweeps": [...]}, with an entry as of sweep_entry for each folder that has a sweep, those flown
/// last first; at most 1000.
/// @param sweeps_folder  may be absent
[[nodiscard]] nlohmann::json sweep_list(const std::filesystem::path& sweeps_folder);
/// {"name", "title", "description", "version", "estimators", "repeats", "axes": [{"name", "label",
/// "unit", "values"}], "flying", "progress", "changed_utc"}: `values` are those of all cells,
/// `flying` tells whether a process works on the sweep, `progress` is as of read_progress.
/// Errors: kNotFound, also for a name that is not a plain folder name; as read_json.
[[nodiscard]] Result<nlohmann::json> sweep_entry(const std::filesystem::path& sweeps_folder,
                                                 const std::string& name);

}  // namespace overfly::server::experiments
