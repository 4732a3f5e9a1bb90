#include "flight/logs/boot_clock.hpp"

#include <algorithm>
#include <utility>

#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::int64_t kMaxBackNs = 2 * kNsPerS;
constexpr std::int64_t kMaxAheadNs = 600 * kNsPerS;
constexpr std::int64_t kAgreementNs = 10 * kNsPerS;
/// 100 years: sums and differences of accepted times cannot overflow.
constexpr std::int64_t kLatestNs = 100LL * 366 * 86400 * kNsPerS;

}  // namespace

/// A plausible stamp, this long after the latest one.
void BootClock::follow(std::int64_t step_ns) {
  agreeing_ = 0;
  first_ = std::min(first_ + 1, kBelieved);
  if (before_jump_ns_) {
    least_step_ns_ = std::min(least_step_ns_, step_ns);
    if (++since_jump_ < kBelieved) return;
    before_jump_ns_.reset();
    usual_step_ns_ = std::max<std::int64_t>(least_step_ns_, 0);
  } else if (step_ns > std::max(kMaxBackNs, 2 * usual_step_ns_)) {
    // After a wrong stamp less far ahead, right ones are plausible.
    before_jump_ns_ = latest_->t_ns;
    since_jump_ = 1;
    least_step_ns_ = step_ns;
    right_until_ns_.reset();
  } else {
    usual_step_ns_ = std::min(usual_step_ns_, std::max(step_ns, kMaxBackNs));
  }
}

/// The last of three stamps that agree, but not with the latest time.
LogTime BootClock::believe(std::int64_t t_ns) {
  agreeing_ = 0;
  believed_suspicion_ = suspicions_;
  if (first_ < kBelieved) {
    first_were_wrong_ = true;
    right_until_ns_ = -1;
    implausible_ += static_cast<std::uint64_t>(std::exchange(first_, kBelieved));
    latest_->t_ns = t_ns;
  } else if (before_jump_ns_) {
    right_until_ns_ = before_jump_ns_;
    implausible_ += static_cast<std::uint64_t>(since_jump_);
    latest_->t_ns = *before_jump_ns_;
  }
  before_jump_ns_.reset();
  if (t_ns < latest_->t_ns - kMaxBackNs) {
    latest_ = LogTime{latest_->boot + 1, t_ns};
  } else {
    latest_->t_ns = std::max(latest_->t_ns, t_ns);
  }
  return {latest_->boot, t_ns};
}

std::optional<LogTime> BootClock::take(std::int64_t t_ns) {
  if (t_ns < 0 || t_ns > kLatestNs) {
    ++implausible_;
    return std::nullopt;
  }
  if (!latest_) {
    latest_ = LogTime{0, t_ns};
    first_ = 1;
    return latest_;
  }
  const std::int64_t step_ns = t_ns - latest_->t_ns;
  if (step_ns >= -kMaxBackNs && step_ns <= kMaxAheadNs) {
    follow(step_ns);
    latest_->t_ns = std::max(latest_->t_ns, t_ns);
    return LogTime{latest_->boot, t_ns};
  }
  const std::int64_t from_suspect_ns = t_ns - suspect_ns_;
  const bool agrees =
      agreeing_ > 0 && from_suspect_ns >= -kAgreementNs && from_suspect_ns <= kAgreementNs;
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  if (!agrees) ++suspicions_;
  suspect_ns_ = t_ns;
  if (agreeing_ < kBelieved) {
    ++implausible_;
    return std::nullopt;
  }
  return believe(t_ns);
}

}  // namespace overfly::flight::logs
