#include "vo_bridges/ros1/answer_patience.hpp"

#include <algorithm>

namespace overfly::ros1 {
namespace {

constexpr std::size_t kRememberedFrames = 64;
/// Assumed period of the first frame, whose distance to the next one is unknown.
constexpr std::chrono::nanoseconds kFirstPeriod = std::chrono::milliseconds(100);

}  // namespace

std::chrono::nanoseconds AnswerPatience::begin(std::int64_t t_ns, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  std::chrono::nanoseconds period = kFirstPeriod;
  if (previous_ns_) period = std::chrono::nanoseconds(t_ns - *previous_ns_);
  previous_ns_ = t_ns;
  sent_[t_ns] = now;
  if (sent_.size() > kRememberedFrames) sent_.erase(sent_.begin());
  if (lockstep_) return answers_ ? limit_ : std::min(period, limit_);
  return std::min(std::max(period, 2 * latency_), limit_);
}

void AnswerPatience::answered(std::int64_t t_ns, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto sent = sent_.lower_bound(t_ns - kStampToleranceNs);
  if (sent == sent_.end() || sent->first > t_ns + kStampToleranceNs) return;
  answers_ = true;
  // Running mean over about ten answers, so that a single slow answer is forgotten within a second.
  constexpr int kAnswers = 10;
  const std::chrono::nanoseconds took = now - sent->second;
  latency_ = latency_.count() == 0 ? took : latency_ + (took - latency_) / kAnswers;
  sent_.erase(sent);
}

void AnswerPatience::gave_up() {
  const std::lock_guard lock(mutex_);
  answers_ = false;
}

}  // namespace overfly::ros1
