#include "vo_bridges/lcm/lcm_estimator.hpp"

#include <utility>

#include "middleware/lcm/network.hpp"
#include "vo_bridges/lcm/lcm_claim.hpp"
#include "vo_bridges/lcm/lcm_door.hpp"
#include "vo_bridges/lcm/lcm_option_check.hpp"

namespace overfly {

Result<std::unique_ptr<VoPort>> create_lcm_estimator(const LcmEstimatorOptions& options) {
  const Result<lcm::Url> url = check_lcm_options(options);
  if (!url) return url.error();
  std::shared_ptr<LcmClaim> claim;
  if (url->provider != "memq") {  // memq connects only nodes of one process
    auto taken = LcmClaim::take(lcm::network_of(options.url), options.channel_prefix);
    if (!taken) return taken.error();
    claim = std::move(*taken);
  }
  Result<std::shared_ptr<lcm::Node>> node =
      lcm::Node::open(lcm::with_receive_buffer(*url), options.cancel);
  if (!node) return node.error();
  return create_lcm_estimator_on(std::move(*node), options, std::move(claim));
}

}  // namespace overfly
