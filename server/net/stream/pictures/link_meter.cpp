#include "server/net/stream/pictures/link_meter.hpp"

#include <algorithm>
#include <array>

namespace overfly::net {
namespace {

constexpr std::int64_t kWindowNs = 1'000'000'000;
/// Of a window, for which pictures must have moved to judge it.
constexpr double kLeastMoving = 0.5;
constexpr double kMuchBlocked = 0.4;
constexpr double kLittleBlocked = 0.1;
constexpr int kFirstWait = 3;
constexpr int kLongestWait = 60;
/// A step back was too early if pictures wait again within this many windows.
constexpr int kTrialWindows = 5;

}  // namespace

Reduction reduction_at(int step) {
  constexpr std::array<Reduction, LinkMeter::kMostReduction + 1> kSteps = {
      {{0, 0}, {15, 0}, {30, 0}, {30, 1}, {40, 2}}};
  return kSteps[static_cast<std::size_t>(std::clamp(step, 0, LinkMeter::kMostReduction))];
}

void LinkMeter::note(bool moving, bool blocked, std::int64_t now_ns) {
  if (window_began_ns_ == 0) {
    window_began_ns_ = noted_ns_ = now_ns;
    windows_to_wait_ = kFirstWait;
    windows_since_restored_ = kTrialWindows;
  }
  const std::int64_t since_ns = now_ns - noted_ns_;
  if (moving_) moving_ns_ += since_ns;
  if (moving_ && blocked_) blocked_ns_ += since_ns;
  noted_ns_ = now_ns;
  moving_ = moving;
  blocked_ = blocked;
  if (now_ns - window_began_ns_ >= kWindowNs) close_window(now_ns);
}

void LinkMeter::close_window(std::int64_t now_ns) {
  const auto window = static_cast<double>(now_ns - window_began_ns_);
  const auto moving = static_cast<double>(moving_ns_);
  const double share = moving > 0.0 ? static_cast<double>(blocked_ns_) / moving : 0.0;
  window_began_ns_ = now_ns;
  moving_ns_ = blocked_ns_ = 0;
  if (moving < kLeastMoving * window) return;
  ++windows_since_restored_;
  if (share > kMuchBlocked) {
    if (windows_since_restored_ <= kTrialWindows) {
      windows_to_wait_ = std::min(2 * windows_to_wait_, kLongestWait);
      too_early_at_ = reduction_;
      windows_since_restored_ = kTrialWindows;
    }
    reduction_ = std::min(reduction_ + 1, kMostReduction);
    calm_windows_ = 0;
  } else if (share < kLittleBlocked && reduction_ > 0) {
    if (windows_since_restored_ > kTrialWindows && reduction_ <= too_early_at_) {
      // The step that was too early before holds now: the way has become wider.
      windows_to_wait_ = kFirstWait;
      too_early_at_ = -1;
    }
    const bool may_be_too_early = reduction_ - 1 <= too_early_at_;
    if (++calm_windows_ < (may_be_too_early ? windows_to_wait_ : kFirstWait)) return;
    --reduction_;
    calm_windows_ = 0;
    windows_since_restored_ = 0;
  } else {
    calm_windows_ = 0;
  }
}

}  // namespace overfly::net
