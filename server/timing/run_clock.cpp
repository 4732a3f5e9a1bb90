#include "server/timing/run_clock.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace overfly::server {
namespace {

class MachineClock final : public RunClock {
 public:
  std::int64_t now_ns() override {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
  void sleep_until_ns(std::int64_t t_ns) override {
    std::this_thread::sleep_until(
        std::chrono::steady_clock::time_point(std::chrono::nanoseconds(t_ns)));
  }
  bool wait_until_ns(std::int64_t t_ns, const std::function<bool()>& cancelled) override {
    constexpr std::int64_t kLookEveryNs = 50'000'000;
    while (!cancelled()) {
      const std::int64_t from_ns = now_ns();
      if (from_ns >= t_ns) return true;
      sleep_until_ns(std::min(t_ns, from_ns + kLookEveryNs));
    }
    return false;
  }
};

}  // namespace

RunClock& machine_clock() {
  static MachineClock clock;
  return clock;
}

}  // namespace overfly::server
