// After lcm/eventlog.h: an event is a sync word, its number, its time [us], the lengths of channel
// and data, and these two; all numbers are big-endian.
#include "flight/logs/lcm/lcm_events.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include "core/text/number_text.hpp"
#include "flight/logs/lcm/lcm_messages.hpp"
#include "flight/logs/record_pass.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kEventHeaderBytes = 28;
/// LCM limits names to 63 characters.
constexpr std::size_t kMaxChannelBytes = 255;
/// Bytes of an event that are looked at; all fields that are read are in front.
constexpr std::size_t kEventWindowBytes = 66560;

/// The event at the start of `bytes`; empty if there is none, or if it ends behind `left` bytes.
std::optional<LcmEvent> event_at(std::span<const std::uint8_t> bytes, std::uint64_t left) {
  if (bytes.size() < kEventHeaderBytes || big_endian_at<std::uint32_t>(bytes, 0) != kSyncWord) {
    return std::nullopt;
  }
  const auto number = big_endian_at<std::int64_t>(bytes, 4);
  const auto channel_bytes = big_endian_at<std::int32_t>(bytes, 20);
  const auto data_bytes = big_endian_at<std::int32_t>(bytes, 24);
  if (number < 0 || channel_bytes <= 0 || channel_bytes > std::int32_t{kMaxChannelBytes} ||
      data_bytes < 0) {
    return std::nullopt;
  }
  LcmEvent event;
  const auto data_at = kEventHeaderBytes + static_cast<std::size_t>(channel_bytes);
  event.data_bytes = static_cast<std::uint64_t>(data_bytes);
  event.data_at = data_at;
  event.bytes = data_at + event.data_bytes;
  if (event.bytes > left || data_at > bytes.size()) return std::nullopt;
  event.recorded_us = big_endian_at<std::int64_t>(bytes, 12);
  event.channel = bytes.subspan(kEventHeaderBytes, static_cast<std::size_t>(channel_bytes));
  event.data = bytes.subspan(data_at).first(
      std::min(static_cast<std::size_t>(data_bytes), bytes.size() - data_at));
  return event;
}

/// Finds the events and counts what is between them.
class LcmFraming {
 public:
  /// @param bytes  that follow the position of `file`
  /// @return the bytes to move on: over an event, or to where one may begin
  /// Errors: kIo.
  Result<std::uint64_t> step(std::span<const std::uint8_t> bytes,
                             const ForwardReader& file,
                             const std::function<void(const LcmEvent&)>& take) {
    const std::uint64_t left = file.size_bytes() - file.position();
    std::optional<LcmEvent> event = event_at(bytes, left);
    // Believed if another one or the end of the file follows: a flipped bit in the length of the
    // data would else skip what follows.
    const Result<bool> followed =
        !event || event->bytes == left ? event.has_value() : begins_at(event->bytes, bytes, file);
    if (!followed) return followed.error();
    if (!*followed) {
      constexpr std::uint8_t kFirstByte = kSyncWord >> 24U;
      const auto next = std::find(bytes.begin() + 1, bytes.end(), kFirstByte);
      const auto skipped = static_cast<std::uint64_t>(next - bytes.begin());
      skipped_bytes_ += skipped;
      if (std::exchange(in_step_, false)) ++damaged_places_;
      return skipped;
    }
    in_step_ = true;
    event->data_at += file.file_offset();
    take(*event);
    return event->bytes;
  }

  void report(LogSink& sink) const {
    if (skipped_bytes_ == 0) return;
    sink.warning(std::to_string(skipped_bytes_) + " bytes in " + counted(damaged_places_, "place") +
                 " belong to no complete event and were skipped");
  }

 private:
  /// Whether an event begins `distance` behind the position.
  static Result<bool> begins_at(std::uint64_t distance,
                                std::span<const std::uint8_t> bytes,
                                const ForwardReader& file) {
    std::array<std::uint8_t, 4> word{};
    if (distance + word.size() <= bytes.size()) {
      const auto at = static_cast<std::size_t>(distance);
      return big_endian_at<std::uint32_t>(bytes, at) == kSyncWord;
    }
    const Result<std::size_t> read = file.peek(distance, word);
    if (!read) return read.error();
    return *read == word.size() && big_endian_at<std::uint32_t>(word, 0) == kSyncWord;
  }

  bool in_step_ = true;
  std::uint64_t skipped_bytes_ = 0;
  std::uint64_t damaged_places_ = 0;
};

}  // namespace

bool is_lcm_log(std::span<const std::uint8_t> head) {
  return event_at(head, std::uint64_t{1} << 32U).has_value();
}

Status read_lcm_events(ForwardReader& file,
                       LogSink& sink,
                       const std::function<void(const LcmEvent&)>& take) {
  LcmFraming framing;
  Status status = take_all_records(file, sink, [&]() -> Result<bool> {
    const Result<std::span<const std::uint8_t>> bytes = file.ahead(kEventWindowBytes);
    if (!bytes) return bytes.error();
    if (bytes->empty()) return false;
    const Result<std::uint64_t> step = framing.step(*bytes, file, take);
    if (!step) return step.error();
    const Result<std::uint64_t> passed = pass_over(file, *step, {});
    if (!passed) return passed.error();
    return true;
  });
  if (status) framing.report(sink);
  return status;
}

}  // namespace overfly::flight::logs
