#include "renderer/ground/ground_corners.hpp"

#include <utility>

namespace overfly::renderer {

GroundCorners::GroundCorners() : slots_(8192) {}

std::size_t GroundCorners::slot_of(const LatticePoint& at) const {
  std::uint64_t h = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(at[0])) << 32U) |
                    static_cast<std::uint32_t>(at[1]);
  h *= 0x9E3779B97F4A7C15ULL;
  h ^= h >> 32U;
  h *= 0xD6E8FEB86659FD93ULL;
  std::size_t slot = (h >> 32U) & (slots_.size() - 1);
  while (slots_[slot].point != nullptr && slots_[slot].at != at) {
    slot = (slot + 1) & (slots_.size() - 1);
  }
  return slot;
}

void GroundCorners::add(const LatticePoint& at, const Eigen::Vector3d& point, int level) {
  Slot& slot = slots_[slot_of(at)];
  if (slot.point != nullptr) {
    if (level < slot.level) slot = {at, &point, level};
    return;
  }
  slot = {at, &point, level};
  if (2 * ++used_ > slots_.size()) grow();
}

const Eigen::Vector3d* GroundCorners::find(const LatticePoint& at) const {
  return slots_[slot_of(at)].point;
}

void GroundCorners::grow() {
  std::vector<Slot> old(2 * slots_.size());
  std::swap(old, slots_);
  for (const Slot& slot : old) {
    if (slot.point != nullptr) slots_[slot_of(slot.at)] = slot;
  }
}

}  // namespace overfly::renderer
