#include "server/net/stream/pictures/picture_slot.hpp"

#include <algorithm>

namespace overfly::net {
namespace {

/// After a seek or a change of the view, even a slow stream shows the next picture within this
/// period [ns].
constexpr std::int64_t kChangePeriodNs = 30'000'000;

}  // namespace

std::int64_t PictureSlot::ready_ns() const {
  if (!taken_ || taken_->change == wanted_->change) return due_ns_;
  const std::int64_t change_ns = std::max(std::min(period_ns_, kChangePeriodNs), least_period_ns_);
  return std::min(due_ns_, taken_at_ns_ + change_ns);
}

bool PictureSlot::blocked(std::int64_t now_ns) const {
  return wanted_ && wanted_ != taken_ && (window_full() || sending_) && now_ns >= ready_ns();
}

bool PictureSlot::due(std::int64_t now_ns) const {
  return waiting() && !window_full() && now_ns >= ready_ns();
}

std::optional<PictureKey> PictureSlot::take(std::int64_t now_ns) {
  if (!due(now_ns)) return std::nullopt;
  const bool changed = taken_ && taken_->change != wanted_->change;
  const std::int64_t period_ns = std::max(period_ns_, least_period_ns_);
  // Measured from the time it was due, so that late ticks do not lower the rate.
  const bool on_time = !changed && now_ns - due_ns_ < period_ns;
  due_ns_ = (on_time ? due_ns_ : now_ns) + period_ns;
  taken_ = wanted_;
  taken_at_ns_ = now_ns;
  in_flight_ = true;
  return taken_;
}

}  // namespace overfly::net
