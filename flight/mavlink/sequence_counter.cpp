#include "flight/mavlink/sequence_counter.hpp"

namespace overfly::flight::mavlink {
namespace {

/// Numbers that are remembered one by one.
constexpr unsigned kSequenceWindow = 64;
/// Numbers less than this ahead are ahead; all others are behind.
constexpr unsigned kHalfTurn = 128;

}  // namespace

void SequenceCounter::start_at(std::uint8_t sequence) {
  started_ = true;
  suspects_restart_ = false;
  latest_ = sequence;
  received_ = ~std::uint64_t{0};  // nothing before the first message counts as lost
}

SequenceCounter::Verdict SequenceCounter::take(std::uint8_t sequence) {
  if (!started_) {
    start_at(sequence);
    return Verdict::kFirst;
  }
  const unsigned ahead = static_cast<std::uint8_t>(sequence - latest_);
  if (ahead != 0 && ahead < kHalfTurn) {
    lost_ += ahead - 1;
    received_ = ahead < kSequenceWindow ? received_ << ahead : 0;
    received_ |= 1U;
    latest_ = sequence;
    suspects_restart_ = false;
    return ahead == 1 ? Verdict::kInOrder : Verdict::kAfterLoss;
  }
  const unsigned behind = static_cast<std::uint8_t>(latest_ - sequence);
  if (behind < kSequenceWindow) {
    const std::uint64_t bit = std::uint64_t{1} << behind;
    if ((received_ & bit) != 0) {
      ++duplicates_;
      return Verdict::kDuplicate;
    }
    received_ |= bit;
    ++late_;
    --lost_;
    return Verdict::kLate;
  }
  if (suspects_restart_ && sequence == suspect_) {
    --misplaced_;
    ++restarts_;
    start_at(sequence);
    return Verdict::kRestart;
  }
  ++misplaced_;
  suspects_restart_ = true;
  suspect_ = static_cast<std::uint8_t>(sequence + 1);
  return Verdict::kMisplaced;
}

}  // namespace overfly::flight::mavlink
