// What two runs are compared by.
#pragma once

#include <nlohmann/json.hpp>

#include "server/record/run_manifest.hpp"

namespace overfly::server {

/// What a run is made of, for comparing runs: its scenario as flown, the parameters that its
/// estimators used, and of its manifest what the scenario does not say.
[[nodiscard]] nlohmann::json compared_document(const RunManifest& run_manifest,
                                               nlohmann::json scenario);

}  // namespace overfly::server
