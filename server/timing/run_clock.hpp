// The clock that paces a real-time run and times the stages of every run.
#pragma once

#include <cstdint>

namespace overfly::engine {

/// Nanoseconds from any fixed instant. Thread-safe.
///
/// A clock that is simulated needs to know who is at work: it may only move on when each worker
/// sleeps. So a thread enters before it works and leaves when it waits for others' work; the
/// machine's clock does not care.
class RunClock {
 public:
  virtual ~RunClock() = default;
  [[nodiscard]] virtual std::int64_t now_ns() = 0;
  virtual void sleep_until_ns(std::int64_t t_ns) = 0;
  virtual void enter() {}
  virtual void leave() {}
};

/// The machine's steady clock.
[[nodiscard]] RunClock& machine_clock();

}  // namespace overfly::engine
