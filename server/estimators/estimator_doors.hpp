// Estimators outside this process: converts a spec into the options of its door.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "server/estimators/estimator_setting.hpp"
#include "server/scenario/estimator_spec.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::server {

/// @pre is_outside_estimator(spec.type)
/// Errors: as create_estimator.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_outside_estimator(
    const EstimatorSpec& spec, const EstimatorSetting& setting);

}  // namespace overfly::server
