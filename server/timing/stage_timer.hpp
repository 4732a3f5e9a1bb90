// Measures the wall-clock time of each stage of a run.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/timing/latency_summary.hpp"
#include "server/timing/run_clock.hpp"

namespace overfly::server {

/// Durations of one stage.
struct DurationList {
  std::vector<double> ms;
  /// {"count", "total_ms", "mean_ms", "median_ms", "p95_ms", "p99_ms", "max_ms"}
  [[nodiscard]] nlohmann::json summary() const;
  /// Empty without durations.
  [[nodiscard]] std::optional<LatencySummary> latencies() const;
};

/// Durations by stage. Not thread-safe.
class StageTimer {
 public:
  explicit StageTimer(RunClock& clock) : clock_(clock) {}

  /// Runs `work` and adds its duration to `stage`.
  template <typename Work>
  auto measure(const std::string& stage, const Work& work) {
    const Booking booking(*this, stage);
    return work();
  }
  [[nodiscard]] nlohmann::json summary() const;

 private:
  class Booking {
   public:
    Booking(StageTimer& timer, const std::string& stage)
        : timer_(timer), stage_(stage), begin_ns_(timer.clock_.now_ns()) {}
    ~Booking() {
      const std::int64_t elapsed_ns = timer_.clock_.now_ns() - begin_ns_;
      timer_.stages_[stage_].ms.push_back(static_cast<double>(elapsed_ns) * 1e-6);
    }
    Booking(const Booking&) = delete;
    Booking& operator=(const Booking&) = delete;

   private:
    StageTimer& timer_;
    const std::string& stage_;
    std::int64_t begin_ns_;
  };

  RunClock& clock_;
  std::map<std::string, DurationList> stages_;
};

}  // namespace overfly::server
