#include "server/timing/picture_rate.hpp"

#include <algorithm>
#include <array>

#include "core/time.hpp"

namespace overfly::server {
namespace {

/// The last step means no limit.
constexpr std::array<double, 6> kSteps_hz = {
    PictureRate::kLeastHz, 2.0, PictureRate::kFirstHz, 10.0, 15.0, 0.0};
constexpr std::size_t kFirstStep = 2;
constexpr std::int64_t kWindowNs = kNsPerS;
/// Fraction of a frame's period: with less time left the frame counts as tight.
constexpr double kTightShare = 0.1;
constexpr int kFirstWait = 2;
constexpr int kLongestWait = 60;
/// A step up was too much if a step down follows within this many windows.
constexpr int kTrialWindows = 5;

}  // namespace

void PictureRate::flight_began(std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  if (flights_++ > 0) return;
  step_ = kFirstStep;
  window_ = Window{now_ns};
  calm_windows_ = 0;
  windows_to_wait_ = kFirstWait;
  windows_since_step_up_ = kTrialWindows;
}

void PictureRate::flight_ended() {
  const std::lock_guard lock(mutex_);
  --flights_;
}

void PictureRate::frame_made(std::int64_t now_ns, std::int64_t period_ns, std::int64_t left_ns) {
  const std::lock_guard lock(mutex_);
  ++window_.frames;
  if (static_cast<double>(left_ns) < kTightShare * static_cast<double>(period_ns)) ++window_.tight;
  close_window(now_ns);
}

void PictureRate::frame_missed(std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  ++window_.missed;
  close_window(now_ns);
}

void PictureRate::picture_made() {
  const std::lock_guard lock(mutex_);
  ++window_.pictures;
}

/// A missed frame acts immediately; calm counts only in whole windows.
void PictureRate::close_window(std::int64_t now_ns) {
  const bool over = now_ns - window_.begin_ns >= kWindowNs;
  const bool pressed = window_.missed > 0 || (over && 2 * window_.tight > window_.frames);
  if (pressed) {
    step_down();
  } else if (over && window_.pictures > 0) {
    ++windows_since_step_up_;
    if (++calm_windows_ >= windows_to_wait_) step_up();
  }
  if (pressed || over) window_ = Window{now_ns};
}

void PictureRate::step_down() {
  calm_windows_ = 0;
  if (windows_since_step_up_ < kTrialWindows) {
    windows_to_wait_ = std::min(2 * windows_to_wait_, kLongestWait);
    windows_since_step_up_ = kTrialWindows;
  }
  if (step_ > 0) --step_;
}

void PictureRate::step_up() {
  calm_windows_ = 0;
  if (step_ + 1 == kSteps_hz.size()) return;
  ++step_;
  windows_since_step_up_ = 0;
}

bool PictureRate::flying() const {
  const std::lock_guard lock(mutex_);
  return flights_ > 0;
}

std::optional<double> PictureRate::limit_hz() const {
  const std::lock_guard lock(mutex_);
  if (flights_ == 0 || step_ + 1 == kSteps_hz.size()) return std::nullopt;
  return kSteps_hz[step_];
}

}  // namespace overfly::server
