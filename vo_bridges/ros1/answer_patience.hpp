// How long a frame waits for its answer, from an estimator that does not say beforehand whether it
// answers each one.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

namespace overfly::ros1 {

/// How far an answer's stamp may be off its frame's: nodes keep time in doubles.
inline constexpr std::int64_t kStampToleranceNs = 400'000;

/// In lockstep a frame waits up to the time limit while the estimator is known to answer, and else
/// for one frame's period, so that time goes on by the clock for one that initialises, is lost, or
/// answers some frames only. Without lockstep a frame waits for one period, or for twice as long as
/// the last answers took where that is more. Methods may be called from any thread.
class AnswerPatience {
 public:
  using Clock = std::chrono::steady_clock;

  AnswerPatience(bool lockstep, std::chrono::nanoseconds limit)
      : lockstep_(lockstep), limit_(limit) {}

  /// A frame goes out. @return for how long to wait for its answer
  [[nodiscard]] std::chrono::nanoseconds begin(std::int64_t t_ns, Clock::time_point now);
  /// An answer arrived, in time or late; one whose stamp is that of no frame changes nothing.
  void answered(std::int64_t t_ns, Clock::time_point now);
  /// A frame was not answered in time.
  void gave_up();
  /// For an estimator that starts anew.
  void forget();

 private:
  const bool lockstep_;
  const std::chrono::nanoseconds limit_;
  std::mutex mutex_;
  std::map<std::int64_t, Clock::time_point> sent_;  ///< the last of them, by stamp
  std::optional<std::int64_t> previous_ns_;
  bool answers_ = true;  ///< the first frame is given a chance
  std::chrono::nanoseconds latency_{0};
};

}  // namespace overfly::ros1
