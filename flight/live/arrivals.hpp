// When the states of a live source became known.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "flight/live/live_samples.hpp"

namespace overfly::flight::live {

/// Not thread-safe.
class Arrivals {
 public:
  using Clock = std::chrono::steady_clock;

  /// The states up to a time of the source's clock are known from now on.
  void add(std::int64_t known_until_ns) {
    last_ = Clock::now();
    known_.push_back({known_until_ns, last_});
    if (known_.size() > kMaxLiveSamples) known_.pop_front();
  }
  /// The source's clock starts again: what was known is forgotten. A wait has heard it now.
  void restart() {
    known_.clear();
    used_.reset();
    last_ = Clock::now();
  }
  /// The state at a time is used; times do not decrease.
  void use(std::int64_t t_ns) {
    while (!known_.empty() && known_.front().until_ns < t_ns) known_.pop_front();
    used_.reset();
    if (!known_.empty()) used_ = known_.front().at;
  }
  /// The latest state is used.
  void use_latest() { used_ = last_; }

  /// When the state became known that was used last [ns of the machine's steady clock].
  [[nodiscard]] std::optional<std::int64_t> used_ns() const {
    if (!used_) return std::nullopt;
    return std::chrono::duration_cast<std::chrono::nanoseconds>(used_->time_since_epoch()).count();
  }
  /// How long a wait that began then has been without a new state. It counts from the later of
  /// both: a run that has paused must not blame its source.
  [[nodiscard]] Clock::duration silence(Clock::time_point wait_began) const {
    return Clock::now() - std::max(last_, wait_began);
  }

 private:
  struct Known {
    std::int64_t until_ns = 0;
    Clock::time_point at;
  };
  std::deque<Known> known_;
  Clock::time_point last_;
  std::optional<Clock::time_point> used_;
};

}  // namespace overfly::flight::live
