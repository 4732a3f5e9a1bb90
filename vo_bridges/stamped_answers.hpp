// Answers from another program, which arrive on another thread in any order or not at all. Each is
// matched by its stamp to the frame that waits for it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>

#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Each delivered answer counts once as answered, late, duplicate or unknown.
struct AnswerCounts {
  std::int64_t answered = 0;      ///< first answer to its frame, before the frame was given up
  std::int64_t late = 0;          ///< first answer to a frame that was given up
  std::int64_t duplicate = 0;     ///< further answer to the same frame
  std::int64_t unknown = 0;       ///< no frame has this stamp, or the frame is too old
  std::int64_t out_of_order = 0;  ///< answered or late, but older than a previous answer
  std::int64_t unanswered = 0;    ///< frames that were given up
};

/// Thread-safe.
class StampedAnswers {
 public:
  /// @param tolerance_ns  allowed difference between the stamps of an answer and its frame.
  /// Estimators that store seconds as a double return Unix times to about 120 ns. Must be less than
  /// half a frame period. @pre >= 0
  explicit StampedAnswers(std::int64_t tolerance_ns = 0) : tolerance_ns_(tolerance_ns) {}

  /// Registers a frame with a stamp later than all before it. Call before the frame is sent.
  void expect(std::int64_t t_ns);
  /// Accepts an incoming answer. It is kept only if its frame is neither answered nor given up.
  /// @return whether it was kept
  bool deliver(std::int64_t t_ns, VoEstimate answer);
  /// Waits for the answer to an expected frame and returns it, at most once. Empty after `timeout`,
  /// when stopped, or if the frame is not expected; the frame stays expected.
  [[nodiscard]] std::optional<VoEstimate> wait(std::int64_t t_ns, std::chrono::nanoseconds timeout);
  /// Stops expecting an unanswered frame: an answer to it counts as late from now on.
  void give_up(std::int64_t t_ns);
  /// Waits, and gives the frame up if there is no answer in time.
  [[nodiscard]] std::optional<VoEstimate> take(std::int64_t t_ns, std::chrono::nanoseconds timeout);

  /// Ends every current and future wait: one of the two ends has left.
  void stop();
  [[nodiscard]] bool stopped() const;
  [[nodiscard]] AnswerCounts counts() const;

 private:
  struct Frame {
    bool given_up = false;
    bool answered = false;
    std::optional<VoEstimate> answer;  ///< until taken
  };
  using Frames = std::map<std::int64_t, Frame>;

  [[nodiscard]] Frames::iterator nearest(std::int64_t t_ns);

  const std::int64_t tolerance_ns_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Frames frames_;  ///< by stamp; kept for a while, to recognise late answers
  std::optional<std::int64_t> newest_answered_ns_;
  AnswerCounts counts_;
  bool stopped_ = false;
};

}  // namespace overfly
