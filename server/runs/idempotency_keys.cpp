#include "server/runs/idempotency_keys.hpp"

namespace overfly::server {

std::optional<IdempotencyKeys::Start> IdempotencyKeys::start_of(const std::string& key, Time now) {
  drop_old(now);
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) return std::nullopt;
  entries_.splice(entries_.begin(), entries_, found->second);
  return Start{found->second->run_id, found->second->key.body_digest};
}

void IdempotencyKeys::keep(const IdempotencyKey& key, const std::string& run_id, Time now) {
  if (key.text.empty()) return;
  drop_old(now);
  if (const auto known = by_key_.find(key.text); known != by_key_.end())
    entries_.erase(known->second);
  entries_.push_front({key, run_id, now});
  by_key_[key.text] = entries_.begin();
  if (entries_.size() <= kMostKeys) return;
  by_key_.erase(entries_.back().key.text);
  entries_.pop_back();
}

void IdempotencyKeys::forget_run(const std::string& run_id) {
  std::erase_if(entries_, [&](const Entry& entry) {
    if (entry.run_id != run_id) return false;
    by_key_.erase(entry.key.text);
    return true;
  });
}

void IdempotencyKeys::drop_old(Time now) {
  std::erase_if(entries_, [&](const Entry& entry) {
    if (now - entry.kept < kOldest) return false;
    by_key_.erase(entry.key.text);
    return true;
  });
}

}  // namespace overfly::server
