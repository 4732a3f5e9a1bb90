// The sweep files that a server offers its clients: the folder `sweeps` next to its scenarios.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"

namespace overfly::server::experiments {

/// @param scenarios_folder  of the server
[[nodiscard]] std::filesystem::path sweep_files_folder(
    const std::filesystem::path& scenarios_folder);

/// [{"name", "title", "description", "error"}], by name; at most 1000. `error` is null if the file
/// is a sweep.
/// @param folder  may be absent
[[nodiscard]] nlohmann::json sweep_file_list(const std::filesystem::path& folder);

/// A sweep file as written. Errors: kNotFound, also for a name that is not plain; as read_json.
[[nodiscard]] Result<nlohmann::json> sweep_file_document(const std::filesystem::path& folder,
                                                         const std::string& name);

/// Names of the files of published errors that tables may show, in `published` in that folder.
[[nodiscard]] nlohmann::json published_file_list(const std::filesystem::path& folder);
/// Such a file. Errors: kNotFound, also for a name that is not plain.
[[nodiscard]] Result<std::filesystem::path> published_file(const std::filesystem::path& folder,
                                                           const std::string& name);

}  // namespace overfly::server::experiments
