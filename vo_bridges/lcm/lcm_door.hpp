// The LCM door on an existing node: that of a network, or a test's, whose other end shares a memq
// node.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "middleware/lcm/node.hpp"
#include "vo_bridges/lcm/lcm_claim.hpp"
#include "vo_bridges/lcm/lcm_options.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// As create_lcm_estimator, on a node that has not been started; starts it.
/// @param claim  released with the estimator; null if no other estimator can use the channels
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_lcm_estimator_on(
    std::shared_ptr<lcm::Node> node,
    const LcmEstimatorOptions& options,
    std::shared_ptr<LcmClaim> claim = nullptr);

}  // namespace overfly
