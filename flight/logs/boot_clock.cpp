#include "flight/logs/boot_clock.hpp"

#include <algorithm>

#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::int64_t kMaxBackNs = 2 * kNsPerS;
constexpr std::int64_t kMaxAheadNs = 600 * kNsPerS;
constexpr std::int64_t kAgreementNs = 10 * kNsPerS;
/// 100 years: sums and differences of accepted times cannot overflow.
constexpr std::int64_t kLatestNs = 100LL * 366 * 86400 * kNsPerS;

}  // namespace

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
    agreeing_ = 0;
    first_ = std::min(first_ + 1, kBelieved);
    latest_->t_ns = std::max(latest_->t_ns, t_ns);
    return LogTime{latest_->boot, t_ns};
  }
  const std::int64_t from_suspect_ns = t_ns - suspect_ns_;
  const bool agrees =
      agreeing_ > 0 && from_suspect_ns >= -kAgreementNs && from_suspect_ns <= kAgreementNs;
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  suspect_ns_ = t_ns;
  if (agreeing_ < kBelieved) {
    ++implausible_;
    return std::nullopt;
  }
  agreeing_ = 0;
  const bool restart = step_ns < 0 && proven();
  if (!proven()) {
    first_were_wrong_ = true;
    implausible_ += static_cast<std::uint64_t>(first_);
  }
  first_ = kBelieved;
  latest_ = LogTime{latest_->boot + (restart ? 1U : 0U), t_ns};
  return latest_;
}

}  // namespace overfly::flight::logs
