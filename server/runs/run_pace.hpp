// How fast a flight advances, for an estimate of the time that is left.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

namespace overfly::server {

/// Of the last minute: a flight is slower where more is drawn or an estimator has more to do.
class RunPace {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::seconds kWindow{60};

  /// @param frames  done so far; times and frames must not decrease
  void add(Time now, std::int64_t frames);
  /// Time until all frames are done [s]; empty until it is known how fast they come.
  [[nodiscard]] std::optional<double> left_s(std::int64_t frames_total) const;

 private:
  struct Mark {
    Time at;
    std::int64_t frames = 0;
  };
  std::deque<Mark> marks_;
};

}  // namespace overfly::server
