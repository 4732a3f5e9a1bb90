// The LCM door on an open network. For tests, whose other end shares a memq node.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "vo_bridges/lcm/lcm_estimator.hpp"
#include "vo_bridges/lcm/lcm_node.hpp"

namespace overfly {

/// As create_lcm_estimator, on a node that has not been started; starts it.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_lcm_estimator_on(
    std::shared_ptr<LcmNode> node, const LcmEstimatorOptions& options);

}  // namespace overfly
