// Time limits for the answers of an estimator that does not announce which frames it answers.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

namespace overfly::ros1 {

/// Tolerance between the stamps of an answer and its frame: nodes store times as doubles.
inline constexpr std::int64_t kStampToleranceNs = 400'000;

/// In lockstep a frame waits up to the time limit as long as the estimator answers. Otherwise it
/// waits for one frame period, so that time continues at real-time rate while the estimator
/// initialises, is lost, or answers only some frames. Without lockstep a frame waits for one period
/// or for twice the time of the last answers, whichever is longer. Thread-safe.
class AnswerPatience {
 public:
  using Clock = std::chrono::steady_clock;

  AnswerPatience(bool lockstep, std::chrono::nanoseconds limit)
      : lockstep_(lockstep), limit_(limit) {}

  /// Call when a frame is sent. @return how long to wait for its answer
  [[nodiscard]] std::chrono::nanoseconds begin(std::int64_t t_ns, Clock::time_point now);
  /// Call when an answer arrives, in time or late. An answer with the stamp of no frame has no
  /// effect.
  void answered(std::int64_t t_ns, Clock::time_point now);
  /// Call when a frame was not answered in time.
  void gave_up();

 private:
  const bool lockstep_;
  const std::chrono::nanoseconds limit_;
  std::mutex mutex_;
  std::map<std::int64_t, Clock::time_point> sent_;  ///< the latest frames, by stamp
  std::optional<std::int64_t> previous_ns_;
  bool answers_ = true;  ///< initially true, to wait for the first frame
  std::chrono::nanoseconds latency_{0};
};

}  // namespace overfly::ros1
