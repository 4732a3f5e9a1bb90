// The info of one run, read from its folder.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/record/run_info.hpp"

namespace overfly::engine {

/// What the folder says of itself: its manifest, created.json, and the frames
/// written where the run did not come to its end. A run marked running whose lock nobody holds is
/// interrupted. A file or field at fault is told in `problem`, and the others are read.
/// Errors: kNotFound where there is no manifest.
[[nodiscard]] Result<RunInfo> read_run_info(const std::filesystem::path& folder);

/// The fields of a RunInfo that stand in a manifest.
void put_run_info(const RunInfo& info, nlohmann::json& manifest);

}  // namespace overfly::engine
