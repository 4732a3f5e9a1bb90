// The LCM door on a network that is open already: for tests, whose other end shares a memq node.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "vo_bridges/lcm/lcm_estimator.hpp"
#include "vo_bridges/lcm/lcm_node.hpp"

namespace overfly {

/// As create_lcm_estimator, on a node that is not started yet (this starts it).
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_lcm_estimator_on(
    std::shared_ptr<LcmNode> node, const LcmEstimatorOptions& options);

}  // namespace overfly
