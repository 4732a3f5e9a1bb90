// The estimators of a scenario document.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/engine/scenario.hpp"

namespace overfly::engine {

/// Reads `estimators`, and makes the programs in their commands absolute in the document too.
/// @pre the document is valid and has its defaults; cameras and pacing are read
/// @param base  absolute folder of the scenario file
/// Errors: kInvalidArgument with field, value and limit.
[[nodiscard]] Status read_estimators(nlohmann::json& document,
                                     const std::filesystem::path& base,
                                     Scenario& scenario);

/// One estimator's object (an entry of `estimators`) that belongs to no scenario; `camera` and
/// `throttle_hz` say nothing there and are errors.
/// @param base  absolute folder that relative programs count from
/// Errors: kInvalidArgument with every fault as "field = value: must be limit", one a line.
[[nodiscard]] Result<EstimatorSpec> estimator_from_json(nlohmann::json entry,
                                                        const std::filesystem::path& base);

/// Refuses what a scenario may say only where it comes from the machine itself: an estimator whose
/// command, addresses or parameters that may name files (text with a slash) differ from those of
/// every estimator in `trusted`.
/// Errors: kInvalidArgument naming the field.
[[nodiscard]] Status check_reach(const Scenario& scenario, const Scenario& trusted);

}  // namespace overfly::engine
