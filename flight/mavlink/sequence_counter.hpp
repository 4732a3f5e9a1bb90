// Losses of one sender by the sequence numbers of its messages.
#pragma once

#include <cstdint>

namespace overfly::flight::mavlink {

/// Counts the messages of one component that are missing, and those that come twice or late.
///
/// A number up to 127 ahead of the latest one reports the numbers between as lost; one that comes
/// late, at most 63 behind, is no longer lost. A number further behind is believed to be a restart
/// of the sender if the next one follows it (RFC 3550, appendix A.1), and counted as misplaced
/// otherwise.
class SequenceCounter {
 public:
  enum class Verdict { kFirst, kInOrder, kAfterLoss, kLate, kDuplicate, kMisplaced, kRestart };

  /// Takes the number of the next message.
  Verdict take(std::uint8_t sequence);

  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  [[nodiscard]] std::uint64_t late() const { return late_; }
  [[nodiscard]] std::uint64_t duplicates() const { return duplicates_; }
  [[nodiscard]] std::uint64_t misplaced() const { return misplaced_; }
  [[nodiscard]] std::uint64_t restarts() const { return restarts_; }

 private:
  void start_at(std::uint8_t sequence);

  bool started_ = false;
  bool suspects_restart_ = false;
  std::uint8_t latest_ = 0;
  std::uint8_t suspect_ = 0;
  std::uint64_t received_ = 0;  ///< bit k: the number k before the latest one was received
  std::uint64_t lost_ = 0;
  std::uint64_t late_ = 0;
  std::uint64_t duplicates_ = 0;
  std::uint64_t misplaced_ = 0;
  std::uint64_t restarts_ = 0;
};

}  // namespace overfly::flight::mavlink
