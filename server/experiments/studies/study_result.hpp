// What a study has found, for clients of a server.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/experiments/studies/study_request.hpp"

namespace overfly::server::experiments {

/// The result in a study's folder, without names of folders of this machine; runs have the ids
/// STUDY.RUN. Null before there is one.
/// - explain: as explanation.json, and `words`: cause -> what it is called
/// - predict: as predict.json, but of each instant only time, place and risks, and of the map no
///   cells
/// - hunt: as hunt.json, also while it goes on
/// @param folder  of the study; its name is the study's
/// Errors: as read_json; kUnreadable.
[[nodiscard]] Result<nlohmann::json> study_result(StudyKind kind,
                                                  const std::filesystem::path& folder);

/// The page that the command has written: predict.html or explanation.html.
/// Errors: kNotFound; as read_file_text.
[[nodiscard]] Result<std::string> study_page(StudyKind kind, const std::filesystem::path& folder);

/// The scenario of a hunt's worst flight. Errors: kNotFound; as read_json.
[[nodiscard]] Result<nlohmann::json> worst_scenario(const std::filesystem::path& folder);

}  // namespace overfly::server::experiments
