// Answers that come from another program, on another thread, in any order or not at all: each is
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

/// Each answer that was delivered counts once in answered, late, duplicate or unknown.
struct AnswerCounts {
  std::int64_t answered = 0;      ///< the first to its frame, before the frame was given up
  std::int64_t late = 0;          ///< the first to a frame that was given up
  std::int64_t duplicate = 0;     ///< a further one to the same frame
  std::int64_t unknown = 0;       ///< stamped as no frame, or as one too long ago to be remembered
  std::int64_t out_of_order = 0;  ///< of the answered and late: older than one that came before
  std::int64_t unanswered = 0;    ///< frames that were given up
};

/// All methods may be called from any thread.
class StampedAnswers {
 public:
  /// @param tolerance_ns  how far an answer's stamp may be off its frame's: estimators that keep
  ///   time as seconds in a double give back Unix times to about 120 ns. Must be less than half a
  ///   frame's period.
  explicit StampedAnswers(std::int64_t tolerance_ns = 0) : tolerance_ns_(tolerance_ns) {}

  /// Says that a frame is about to be sent, later than all before it. Must come before its answer
  /// can.
  void expect(std::int64_t t_ns);
  /// Takes an answer as it arrives; kept only while its frame is neither answered nor given up.
  /// @return whether it was kept
  bool deliver(std::int64_t t_ns, VoEstimate answer);
  /// The answer to an expected frame, as soon as it is there, at most once. Empty after `timeout`,
  /// when stopped, or when the frame is not expected; the frame is still expected after that.
  [[nodiscard]] std::optional<VoEstimate> wait(std::int64_t t_ns, std::chrono::nanoseconds timeout);
  /// Ends the expectation of a frame that has not been answered: an answer to it is late from now.
  void give_up(std::int64_t t_ns);
  /// Waits, and gives the frame up when there is no answer in time.
  [[nodiscard]] std::optional<VoEstimate> take(std::int64_t t_ns, std::chrono::nanoseconds timeout);

  /// Ends every wait, now and later: the other end is gone, or this one leaves.
  void stop();
  [[nodiscard]] bool stopped() const;
  /// Forgets the frames, for an estimator that starts anew. The counts stay.
  void forget();
  [[nodiscard]] AnswerCounts counts() const;

 private:
  struct Frame {
    bool given_up = false;
    bool answered = false;
    std::optional<VoEstimate> answer;  ///< until it is taken
  };
  using Frames = std::map<std::int64_t, Frame>;

  [[nodiscard]] Frames::iterator nearest(std::int64_t t_ns);

  const std::int64_t tolerance_ns_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Frames frames_;  ///< by stamp; the last of them, so that late answers are known as such
  std::optional<std::int64_t> newest_answered_ns_;
  AnswerCounts counts_;
  bool stopped_ = false;
};

}  // namespace overfly
