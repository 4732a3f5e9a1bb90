#include "server/engine/world_cache.hpp"

#include <utility>

#include "server/engine/scenario_world.hpp"

namespace overfly::engine {

std::shared_ptr<const terrain::World> WorldCache::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  std::erase_if(worlds_, [](const auto& entry) { return entry.second.expired(); });
  const auto known = worlds_.find(key);
  if (known == worlds_.end()) return nullptr;
  std::shared_ptr<const terrain::World> world = known->second.lock();
  if (!world) return nullptr;
  if (!world->tiles->status()) {
    // Heights that could not be read stay unknown in this world.
    worlds_.erase(known);
    return nullptr;
  }
  last_ = world;
  return world;
}

void WorldCache::drop(const std::shared_ptr<const terrain::World>& world) {
  const std::lock_guard lock(mutex_);
  std::erase_if(worlds_, [&](const auto& entry) { return entry.second.lock() == world; });
  if (last_ == world) last_.reset();
}

Result<std::shared_ptr<const terrain::World>> WorldCache::get(
    const Scenario& scenario, const std::function<bool(double)>& progress) {
  const std::string key = world_key(scenario);
  if (std::shared_ptr<const terrain::World> known = find(key)) return known;
  // Opened without the lock, since making the built-in world takes long. Two threads may open the
  // same one; the second then uses the first's.
  Result<terrain::World> opened = open_scenario_world(scenario, progress);
  if (!opened) return opened.error();
  if (std::shared_ptr<const terrain::World> known = find(key)) return known;
  auto world = std::make_shared<const terrain::World>(std::move(*opened));
  const std::lock_guard lock(mutex_);
  worlds_[key] = world;
  last_ = world;
  return std::shared_ptr<const terrain::World>(world);
}

}  // namespace overfly::engine
