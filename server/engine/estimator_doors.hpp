// Estimators outside of this process: a spec made into the options of its door.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "server/engine/estimator_factory.hpp"

namespace overfly::engine {

/// @pre is_outside_estimator(spec.type)
/// Errors: as create_estimator.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_outside_estimator(
    const EstimatorSpec& spec, const EstimatorSetting& setting);

}  // namespace overfly::engine
