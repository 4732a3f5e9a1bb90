#include "flight/mavlink/frame.hpp"

#include <algorithm>
#include <string>

#include "flight/mavlink/checksum.hpp"
#include "flight/mavlink/message_table.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::size_t kHeaderOneBytes = 6;
constexpr std::size_t kHeaderTwoBytes = 10;
constexpr std::size_t kChecksumBytes = 2;
constexpr std::uint8_t kSignedFlag = 0x01;
constexpr std::uint32_t kMaxIdOne = 0xFF;
constexpr std::uint32_t kMaxIdTwo = 0xFFFFFF;

}  // namespace

FrameState take_apart(std::span<const std::uint8_t> bytes, FrameParts& parts) {
  if (bytes.empty()) return FrameState::kIncomplete;
  const std::uint8_t start = bytes[0];
  if (start != kStartOne && start != kStartTwo) return FrameState::kNoFrame;
  const std::size_t header = start == kStartOne ? kHeaderOneBytes : kHeaderTwoBytes;
  if (bytes.size() < header) return FrameState::kIncomplete;
  Frame& frame = parts.frame;
  if (start == kStartOne) {
    frame = {Version::kOne, bytes[2], bytes[3], bytes[4], bytes[5], false, {}};
  } else {
    if ((bytes[2] & ~kSignedFlag) != 0) return FrameState::kNoFrame;
    const std::uint32_t id =
        bytes[7] | (std::uint32_t{bytes[8]} << 8U) | (std::uint32_t{bytes[9]} << 16U);
    frame = {Version::kTwo, bytes[4], bytes[5], bytes[6], id, bytes[2] == kSignedFlag, {}};
  }
  const std::size_t checked = header + bytes[1];
  parts.size_bytes = checked + kChecksumBytes + (frame.is_signed ? kSignatureBytes : 0);
  if (bytes.size() < parts.size_bytes) return FrameState::kIncomplete;
  frame.payload = bytes.subspan(header, bytes[1]);
  parts.checksum_without_extra = add_to_checksum(kChecksumStart, bytes.subspan(1, checked - 1));
  parts.checksum_received =
      static_cast<std::uint16_t>(bytes[checked] | (unsigned{bytes[checked + 1]} << 8U));
  return FrameState::kComplete;
}

Result<std::vector<std::uint8_t>> encode_frame(const Frame& frame) {
  const auto rejected = [&](const std::string& reason) {
    return Error{ErrorCode::kInvalidArgument,
                 "MAVLink message " + std::to_string(frame.message_id) + ": " + reason};
  };
  const MessageFacts* const facts = message_facts(frame.message_id);
  if (facts == nullptr) return rejected("is not in the table of messages");
  const bool first = frame.version == Version::kOne;
  if (frame.message_id > (first ? kMaxIdOne : kMaxIdTwo)) return rejected("needs MAVLink 2");
  if (first && frame.is_signed) return rejected("a signature needs MAVLink 2");
  const std::uint8_t flags = frame.is_signed ? kSignedFlag : 0;
  const std::size_t longest = first ? facts->base_bytes : facts->full_bytes;
  if (frame.payload.size() > longest) {
    return rejected("has a payload of " + std::to_string(frame.payload.size()) +
                    " bytes: must have at most " + std::to_string(longest));
  }
  std::size_t length = first ? longest : frame.payload.size();
  if (!first) {
    while (length > 1 && frame.payload[length - 1] == 0) --length;
    if (length == 0) length = 1;
  }
  const auto id = [&](unsigned shift) {
    return static_cast<std::uint8_t>((frame.message_id >> shift) & 0xFFU);
  };
  const auto size = static_cast<std::uint8_t>(length);
  std::vector<std::uint8_t> bytes = first ? std::vector<std::uint8_t>{kStartOne,
                                                                      size,
                                                                      frame.sequence,
                                                                      frame.system,
                                                                      frame.component,
                                                                      id(0)}
                                          : std::vector<std::uint8_t>{kStartTwo,
                                                                      size,
                                                                      flags,
                                                                      0,
                                                                      frame.sequence,
                                                                      frame.system,
                                                                      frame.component,
                                                                      id(0),
                                                                      id(8),
                                                                      id(16)};
  const std::size_t header = bytes.size();
  bytes.insert(
      bytes.end(),
      frame.payload.begin(),
      frame.payload.begin() + static_cast<std::ptrdiff_t>(std::min(length, frame.payload.size())));
  bytes.resize(header + length, 0);
  const std::uint16_t checksum = add_to_checksum(
      add_to_checksum(kChecksumStart, std::span(bytes).subspan(1)), facts->checksum_extra);
  bytes.push_back(static_cast<std::uint8_t>(checksum & 0xFFU));
  bytes.push_back(static_cast<std::uint8_t>(checksum >> 8U));
  return bytes;
}

}  // namespace overfly::flight::mavlink
