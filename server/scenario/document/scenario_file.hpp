// Converts scenario documents, from files or memory, to scenarios.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Reads, overrides, validates and resolves a scenario file. Relative paths in it are relative to
/// its folder, or to its field `data`.
/// @param sources  files that it may name; those that describe cameras are read, the others are
/// checked by check_scenario
/// Errors: kNotFound; kUnreadable (JSON syntax, with line and column); kInvalidArgument with every
/// invalid field as "field = value: must be limit", one a line; as read_calibrations.
[[nodiscard]] Result<Scenario> load_scenario(const std::filesystem::path& file,
                                             const std::vector<Override>& overrides = {},
                                             const SourcePolicy& sources = {});

/// As load_scenario, for a document in memory; `base` is the folder for its relative paths.
[[nodiscard]] Result<Scenario> resolve_scenario(nlohmann::json document,
                                                const std::vector<Override>& overrides,
                                                const std::filesystem::path& base,
                                                const SourcePolicy& sources = {});

}  // namespace overfly::server
