// A clock for tests of real-time runs in which nothing takes time but waiting.
#pragma once

#include <algorithm>
#include <cstdint>

#include "server/timing/run_clock.hpp"

namespace overfly::server::testing {

/// Time passes only while somebody sleeps. For one thread.
class JumpingClock final : public RunClock {
 public:
  std::int64_t now_ns() override { return now_ns_; }
  void sleep_until_ns(std::int64_t t_ns) override { now_ns_ = std::max(now_ns_, t_ns); }
  void enter() override {}
  void leave() override {}

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace overfly::server::testing
