#include "server/worlds/world_cache.hpp"

#include <utility>

namespace overfly::server {

WorldCache::Shared WorldCache::find(const std::string& key) {
  Shared opened;
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(worlds_, [](const auto& entry) { return entry.second.expired(); });
    const auto known = worlds_.find(key);
    if (known != worlds_.end()) opened = known->second.lock();
  }
  if (!opened) return nullptr;
  // Checked without the lock, so that a slow disk does not delay requests for other worlds. Heights
  // that could not be read stay unknown in an opened world.
  if (terrain::changed_file(opened->files) || !opened->world.tiles->status()) {
    drop(opened);
    return nullptr;
  }
  const std::lock_guard lock(mutex_);
  last_ = opened;
  return opened;
}

void WorldCache::drop(const Shared& world) {
  const std::lock_guard lock(mutex_);
  std::erase_if(worlds_, [&](const auto& entry) { return entry.second.lock() == world; });
  if (last_ == world) last_.reset();
}

Result<WorldCache::Shared> WorldCache::get(const Scenario& scenario,
                                           const std::function<bool(double)>& progress) {
  const std::string key = world_key(scenario);
  if (Shared known = find(key)) return known;
  // Opened without the lock, since making the built-in world takes long. Two threads may open the
  // same world; the second then uses the first one's.
  Result<OpenedWorld> opened = open_scenario_world(scenario, progress);
  if (!opened) return opened.error();
  if (Shared known = find(key)) return known;
  auto world = std::make_shared<const OpenedWorld>(std::move(*opened));
  const std::lock_guard lock(mutex_);
  worlds_[key] = world;
  last_ = world;
  return Shared(world);
}

}  // namespace overfly::server
