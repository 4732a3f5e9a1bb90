#include "flight/logs/tlog/tlog_reader.hpp"

#include <string>

#include "flight/logs/tlog/frame_streams.hpp"
#include "flight/mavlink/frame_finder.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::size_t kStampBytes = 8;
/// Bytes that surely hold a whole record.
constexpr std::size_t kReadAheadBytes = 4096;

std::uint64_t stamp_us(std::span<const std::uint8_t> prefix) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : prefix) value = (value << 8U) | byte;
  return value;
}

void warn_of_frames(const mavlink::FrameCounts& counts,
                    std::uint64_t backward_stamps,
                    LogSink& sink) {
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink.warning(std::to_string(count) + " " + text);
  };
  warn(counts.bad_checksums, "frames with a wrong checksum were left out");
  warn(counts.skipped_bytes, "bytes that belong to no valid frame were skipped");
  warn(counts.lost_messages, "messages are missing according to the sequence numbers");
  warn(backward_stamps, "records were received before the one in front of them");
}

}  // namespace

bool is_tlog(std::span<const std::uint8_t> head) {
  // From 2000 to 2100: bytes that only look like a frame have another stamp in front of them.
  constexpr std::uint64_t kEarliestUs = 946'684'800'000'000;
  constexpr std::uint64_t kLatestUs = 4'102'444'800'000'000;
  mavlink::FrameFinder finder(kStampBytes);
  while (true) {
    const mavlink::FrameFinder::Found found = finder.next(head, true);
    if (!found.frame) return false;
    const std::uint64_t received_us = stamp_us(found.prefix);
    if (received_us >= kEarliestUs && received_us <= kLatestUs) return true;
    head = head.subspan(found.consumed_bytes);
  }
}

Status read_tlog(ForwardReader& file, LogSink& sink) {
  mavlink::FrameFinder finder(kStampBytes);
  FrameStreams streams(sink);
  std::uint64_t last_stamp_us = 0;
  std::uint64_t backward_stamps = 0;
  while (true) {
    const Result<std::span<const std::uint8_t>> bytes = file.ahead(kReadAheadBytes);
    if (!bytes) return bytes.error();
    if (bytes->empty()) break;
    const bool last = bytes->size() < kReadAheadBytes;
    std::size_t used = 0;
    while (true) {
      const mavlink::FrameFinder::Found found = finder.next(bytes->subspan(used), last);
      used += found.consumed_bytes;
      if (!found.frame) break;
      const std::uint64_t received_us = stamp_us(found.prefix);
      if (received_us < last_stamp_us) ++backward_stamps;
      last_stamp_us = received_us;
      streams.take(*found.frame);
    }
    file.skip(used);
    if (!sink.progress(file.position())) {
      return Error{ErrorCode::kCancelled, "reading was cancelled"};
    }
  }
  warn_of_frames(finder.counts(), backward_stamps, sink);
  streams.report();
  return {};
}

}  // namespace overfly::flight::logs
