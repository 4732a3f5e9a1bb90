#include "flight/mavlink/frame_finder.hpp"

#include "flight/mavlink/checksum.hpp"
#include "flight/mavlink/message_table.hpp"

namespace overfly::flight::mavlink {
namespace {

/// Limit for the ids that are not in the table; message sets define a few hundred.
constexpr std::size_t kMaxUnlistedIds = 4096;

}  // namespace

bool FrameFinder::agrees_with_others(const FrameParts& parts) {
  const std::optional<std::uint8_t> extra =
      byte_between(parts.checksum_without_extra, parts.checksum_received);
  if (!extra) return false;
  const auto known = extras_.find(parts.frame.message_id);
  if (known != extras_.end()) {
    if (known->second.value == *extra) {
      known->second.confirmed = true;
      return true;
    }
    if (known->second.confirmed || !in_step_) return false;
    known->second = {*extra, false};
    return true;
  }
  if (!in_step_ || extras_.size() >= kMaxUnlistedIds) return false;
  extras_[parts.frame.message_id] = {*extra, false};
  return true;
}

bool FrameFinder::checksum_is_right(const FrameParts& parts) {
  const MessageFacts* const facts = message_facts(parts.frame.message_id);
  if (facts == nullptr) return agrees_with_others(parts);
  return add_to_checksum(parts.checksum_without_extra, facts->checksum_extra) ==
         parts.checksum_received;
}

void FrameFinder::count_sequence(const Frame& frame) {
  const auto sender = static_cast<std::uint16_t>((unsigned{frame.system} << 8U) | frame.component);
  SequenceCounter& counter = senders_[sender];
  counts_.lost_messages -= counter.lost();
  counter.take(frame.sequence);
  counts_.lost_messages += counter.lost();
}

FrameFinder::Found FrameFinder::next(std::span<const std::uint8_t> bytes, bool last) {
  FrameParts parts;
  std::size_t at = 0;
  while (at + prefix_bytes_ < bytes.size()) {
    const std::span<const std::uint8_t> rest = bytes.subspan(at + prefix_bytes_);
    const FrameState state = take_apart(rest, parts);
    if (state == FrameState::kIncomplete && !last) return {at, std::nullopt, {}, {}};
    if (state == FrameState::kComplete && checksum_is_right(parts)) {
      in_step_ = true;
      ++counts_.frames;
      count_sequence(parts.frame);
      return {at + prefix_bytes_ + parts.size_bytes,
              parts.frame,
              bytes.subspan(at, prefix_bytes_),
              rest.first(parts.size_bytes)};
    }
    // Only one byte is skipped: a wrong length may span frames that are not damaged.
    if (state == FrameState::kComplete && in_step_) ++counts_.bad_checksums;
    in_step_ = false;
    ++at;
    ++counts_.skipped_bytes;
  }
  if (!last) return {at, std::nullopt, {}, {}};
  counts_.skipped_bytes += bytes.size() - at;
  return {bytes.size(), std::nullopt, {}, {}};
}

}  // namespace overfly::flight::mavlink
