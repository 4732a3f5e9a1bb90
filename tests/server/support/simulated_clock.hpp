// A clock for tests of real-time runs: no test waits for the wall's.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>

#include "server/timing/run_clock.hpp"

namespace overfly::server::testing {

/// Advances to the earliest wake-up time when all registered threads sleep.
class SimulatedClock final : public RunClock {
 public:
  std::int64_t now_ns() override {
    const std::lock_guard lock(mutex_);
    return now_ns_;
  }
  void sleep_until_ns(std::int64_t t_ns) override {
    std::unique_lock lock(mutex_);
    if (t_ns <= now_ns_) return;
    const auto mine = sleepers_.emplace(t_ns, false);
    move_on();
    changed_.wait(lock, [&] { return mine->second; });
    sleepers_.erase(mine);
  }
  void enter() override {
    const std::lock_guard lock(mutex_);
    ++at_work_;
  }
  void leave() override {
    const std::lock_guard lock(mutex_);
    --at_work_;
    move_on();
  }

 private:
  void move_on() {
    // Woken threads run again although they are still in the list.
    int asleep = 0;
    for (const auto& [t_ns, woken] : sleepers_) asleep += woken ? 0 : 1;
    if (asleep == 0 || asleep < at_work_) return;
    for (auto& [t_ns, woken] : sleepers_) {
      if (woken) continue;
      now_ns_ = t_ns;
      woken = true;
      changed_.notify_all();
      return;
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::int64_t now_ns_ = 0;
  int at_work_ = 0;
  std::multimap<std::int64_t, bool> sleepers_;
};

}  // namespace overfly::server::testing
