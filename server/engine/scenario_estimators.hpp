// The estimators of a scenario document.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/engine/scenario.hpp"

namespace overfly::engine {

/// Reads `estimators`, and makes the programs in their commands absolute, in the document too.
/// @pre the document is valid and has its defaults; cameras and pacing are read
/// @param base  absolute folder of the scenario file
/// Errors: kInvalidArgument with field, value and limit.
[[nodiscard]] Status read_estimators(nlohmann::json& document,
                                     const std::filesystem::path& base,
                                     Scenario& scenario);

/// Reads one estimator object (an entry of `estimators`) outside a scenario; `camera` and
/// `throttle_hz` have no meaning there and are errors.
/// @param base  absolute folder to which relative programs refer
/// Errors: kInvalidArgument with every invalid field as "field = value: must be limit", one a line.
[[nodiscard]] Result<EstimatorSpec> estimator_from_json(nlohmann::json entry,
                                                        const std::filesystem::path& base);

/// Rejects settings that only the machine's own scenarios may contain: an estimator whose command,
/// addresses or parameters that may name files (text with a slash) differ from those of every
/// estimator in `trusted`.
/// Errors: kInvalidArgument naming the field.
[[nodiscard]] Status check_reach(const Scenario& scenario, const Scenario& trusted);

}  // namespace overfly::engine
