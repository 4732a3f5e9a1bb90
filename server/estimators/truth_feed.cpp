#include "server/estimators/truth_feed.hpp"

namespace overfly::server {

void TruthFeed::add(std::int64_t stamp_ns, const ToyTruth& truth) {
  const std::lock_guard lock(mutex_);
  images_[stamp_ns] = truth;
  if (images_.size() > kTruthFeedImages) images_.erase(images_.begin());
}

std::optional<ToyTruth> TruthFeed::at(std::int64_t stamp_ns) const {
  const std::lock_guard lock(mutex_);
  const auto found = images_.find(stamp_ns);
  if (found == images_.end()) return std::nullopt;
  return found->second;
}

}  // namespace overfly::server
