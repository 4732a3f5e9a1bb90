// Measures the wall time of a stage for `VoEstimate::timing_ms`. Never an input to the estimate.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <utility>

namespace overfly::odometry {

/// Adds the time between construction and destruction to one entry.
class StageStopwatch {
 public:
  StageStopwatch(std::map<std::string, double>& timing_ms, std::string stage)
      : timing_ms_(timing_ms), stage_(std::move(stage)), start_(std::chrono::steady_clock::now()) {}
  ~StageStopwatch() {
    const std::chrono::duration<double, std::milli> passed =
        std::chrono::steady_clock::now() - start_;
    timing_ms_[stage_] += passed.count();
  }
  StageStopwatch(const StageStopwatch&) = delete;
  StageStopwatch& operator=(const StageStopwatch&) = delete;

 private:
  std::map<std::string, double>& timing_ms_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace overfly::odometry
