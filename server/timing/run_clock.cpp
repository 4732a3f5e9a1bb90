#include "server/timing/run_clock.hpp"

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
};

}  // namespace

RunClock& machine_clock() {
  static MachineClock clock;
  return clock;
}

}  // namespace overfly::server
