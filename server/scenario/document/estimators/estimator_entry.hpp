#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/scenario/estimator_spec.hpp"

namespace overfly::server {

/// Reads one estimator object (an entry of `estimators`) outside a scenario; `camera` and
/// `throttle_hz` have no meaning there and are errors.
/// @param base  absolute folder to which relative programs refer
/// Errors: kInvalidArgument with every invalid field as "field = value: must be limit", one a line.
[[nodiscard]] Result<EstimatorSpec> estimator_from_json(nlohmann::json entry,
                                                        const std::filesystem::path& base);

}  // namespace overfly::server
