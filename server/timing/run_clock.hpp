// The clock that paces a real-time run and times the stages of every run.
#pragma once

#include <cstdint>
#include <functional>

namespace overfly::server {

/// Nanoseconds since an arbitrary fixed instant. Thread-safe.
///
/// A simulated clock may advance only when every worker sleeps, so it must know which threads are
/// working. A thread therefore enters before it works and leaves before it waits for other threads.
/// The machine's clock ignores these calls.
class RunClock {
 public:
  virtual ~RunClock() = default;
  [[nodiscard]] virtual std::int64_t now_ns() = 0;
  virtual void sleep_until_ns(std::int64_t t_ns) = 0;
  /// Sleeps until that instant, or until `cancelled()`, which the machine's clock asks every 50 ms.
  /// @return whether it was not cancelled
  [[nodiscard]] virtual bool wait_until_ns(std::int64_t t_ns,
                                           const std::function<bool()>& cancelled) {
    sleep_until_ns(t_ns);
    return !cancelled();
  }
  virtual void enter() {}
  virtual void leave() {}
};

/// The machine's steady clock.
[[nodiscard]] RunClock& machine_clock();

}  // namespace overfly::server
