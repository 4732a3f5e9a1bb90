// Creates estimators: native ones and those behind doors to other processes.
#pragma once

#include <memory>
#include <vector>

#include "core/result.hpp"
#include "server/estimators/estimator_setting.hpp"
#include "server/scenario/estimator_spec.hpp"
#include "vo_bridges/toy/toy_estimators.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::server {

/// @param truth  called only by test estimators; may be empty if there is none
/// Errors: kInvalidArgument naming the estimator, its parameter, value and limit; kUnsupported for
/// a door that is not built in; kNotFound, kIo, kInternal for an estimator that does not start.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_estimator(const EstimatorSpec& spec,
                                                               const EstimatorSetting& setting,
                                                               const ToyTruthAt& truth = {});

/// Checks the parameters of native estimators before anything flies. Those behind doors know theirs
/// only when they run.
/// Errors: kInvalidArgument, a line for each: "estimators.I.parameters.FIELD = VALUE: must be
/// LIMIT".
[[nodiscard]] Status check_native_parameters(const std::vector<EstimatorSpec>& specs);

/// Upper bound of the memory of the images that a native estimator keeps for itself [bytes per
/// pixel of its camera]; 0 for others.
[[nodiscard]] double own_bytes_per_px(const EstimatorSpec& spec);

}  // namespace overfly::server
