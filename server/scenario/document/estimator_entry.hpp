#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/scenario/estimator_spec.hpp"

namespace overfly::engine {

/// One estimator's object (an entry of `estimators`) that belongs to no scenario; `camera` and
/// `throttle_hz` say nothing there and are errors.
/// @param base  absolute folder that relative programs count from
/// Errors: kInvalidArgument with every fault as "field = value: must be limit", one a line.
[[nodiscard]] Result<EstimatorSpec> estimator_from_json(nlohmann::json entry,
                                                        const std::filesystem::path& base);

}  // namespace overfly::engine
