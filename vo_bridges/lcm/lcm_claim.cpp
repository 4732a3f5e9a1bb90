#include "vo_bridges/lcm/lcm_claim.hpp"

#include <mutex>
#include <set>
#include <utility>

namespace overfly {
namespace {

struct Claimed {
  std::mutex mutex;
  std::set<std::string> channels;
};

Claimed& claimed() {
  static Claimed all;
  return all;
}

}  // namespace

LcmClaim::LcmClaim(std::string channels) : channels_(std::move(channels)) {}

LcmClaim::~LcmClaim() {
  const std::lock_guard lock(claimed().mutex);
  claimed().channels.erase(channels_);
}

Result<std::shared_ptr<LcmClaim>> LcmClaim::take(const std::string& network,
                                                 const std::string& prefix) {
  const std::string channels = network + " " + prefix;
  const std::lock_guard lock(claimed().mutex);
  if (!claimed().channels.insert(channels).second) {
    return Error{ErrorCode::kConflict,
                 "channel_prefix = \"" + prefix +
                     "\": another estimator of this process uses it on " + network +
                     "; each needs its own"};
  }
  return std::shared_ptr<LcmClaim>(new LcmClaim(channels));
}

}  // namespace overfly
