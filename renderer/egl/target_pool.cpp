#include "renderer/egl/target_pool.hpp"

#include <algorithm>
#include <utility>

namespace overfly::renderer::egl {

namespace {

constexpr std::size_t kMaxTargets = 8;

}  // namespace

Result<RenderTarget*> TargetPool::get(int width_px, int height_px, TargetFormat format) {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.format == format && entry.target.fits(width_px, height_px);
  });
  if (found != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, found);
    return &entries_.front().target;
  }
  Result<RenderTarget> target = RenderTarget::create(width_px, height_px, format, 0);
  if (!target.ok()) return target.error();
  if (entries_.size() >= kMaxTargets) entries_.pop_back();
  entries_.push_front({format, std::move(*target)});
  return &entries_.front().target;
}

}  // namespace overfly::renderer::egl
