// After lcm/eventlog.h: an event is a sync word, its number, its time [us], the lengths of channel
// and data, and these two; all numbers are big-endian.
#include "flight/logs/lcm/lcm_log_reader.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/text/number_text.hpp"
#include "core/text/printable_text.hpp"
#include "flight/logs/boot_clock.hpp"
#include "flight/logs/lcm/lcm_messages.hpp"
#include "flight/logs/record_pass.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kEventHeaderBytes = 28;
/// LCM limits names to 63 characters.
constexpr std::size_t kMaxChannelBytes = 255;
/// Bytes of an event that are looked at; all fields that are read are in front.
constexpr std::size_t kEventWindowBytes = 65536;
constexpr std::size_t kMaxChannels = 4096;

struct LcmEvent {
  std::int64_t recorded_us = 0;
  std::span<const std::uint8_t> channel;
  std::span<const std::uint8_t> data;  ///< or its start
  std::uint64_t bytes = 0;             ///< of the whole event
};

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
  event.bytes = data_at + static_cast<std::uint64_t>(data_bytes);
  if (event.bytes > left || data_at > bytes.size()) return std::nullopt;
  event.recorded_us = big_endian_at<std::int64_t>(bytes, 12);
  event.channel = bytes.subspan(kEventHeaderBytes, static_cast<std::size_t>(channel_bytes));
  event.data = bytes.subspan(data_at).first(
      std::min(static_cast<std::size_t>(data_bytes), bytes.size() - data_at));
  return event;
}

class LcmPass {
 public:
  explicit LcmPass(LogSink& sink) : sink_(sink) {}

  /// @return the bytes to move on: over an event, or to where one may begin
  std::uint64_t take(std::span<const std::uint8_t> bytes, std::uint64_t left);
  void report();

 private:
  struct Channel {
    StreamId id = 0;
    bool wanted = false;
    LcmType type = LcmType::kOther;
    BootClock clock;
  };

  /// Null if there are too many.
  Channel* channel_of(const LcmEvent& event);
  void take_event(const LcmEvent& event);

  LogSink& sink_;
  std::map<std::pair<std::string, LcmType>, Channel> channels_;
  bool in_step_ = true;
  std::uint64_t skipped_bytes_ = 0;
  std::uint64_t damaged_places_ = 0;
  std::uint64_t short_messages_ = 0;
  std::uint64_t left_out_events_ = 0;
};

std::uint64_t LcmPass::take(std::span<const std::uint8_t> bytes, std::uint64_t left) {
  const std::optional<LcmEvent> event = event_at(bytes, left);
  // Believed if another one or the end of the file follows, as far as that can be seen.
  const bool followed = event && (event->bytes == left || event->bytes + 4 > bytes.size() ||
                                  big_endian_at<std::uint32_t>(
                                      bytes, static_cast<std::size_t>(event->bytes)) == kSyncWord);
  if (!followed) {
    constexpr std::uint8_t kFirstByte = kSyncWord >> 24U;
    const auto next = std::find(bytes.begin() + 1, bytes.end(), kFirstByte);
    const auto step = static_cast<std::uint64_t>(next - bytes.begin());
    skipped_bytes_ += step;
    if (std::exchange(in_step_, false)) ++damaged_places_;
    return step;
  }
  in_step_ = true;
  take_event(*event);
  return event->bytes;
}

LcmPass::Channel* LcmPass::channel_of(const LcmEvent& event) {
  const LcmType type = lcm_type_of(event.data);
  const std::string name = printable_text(event.channel);
  const auto known = channels_.find({name, type});
  if (known != channels_.end()) return &known->second;
  if (channels_.size() >= kMaxChannels) return nullptr;
  const auto id = static_cast<StreamId>(channels_.size());
  Channel& channel = channels_[{name, type}];
  channel.id = id;
  channel.type = type;
  channel.wanted = sink_.stream(id, describe_channel(name, type));
  return &channel;
}

void LcmPass::take_event(const LcmEvent& event) {
  Channel* const channel = channel_of(event);
  if (channel == nullptr) {
    ++left_out_events_;
    return;
  }
  constexpr std::int64_t kMaxUs = std::int64_t{1} << 52U;
  const bool possible = event.recorded_us >= 0 && event.recorded_us < kMaxUs;
  std::optional<std::int64_t> t_ns = possible ? event.recorded_us * 1000 : -1;
  if (channel->type != LcmType::kOther) t_ns = lcm_time_ns(event.data);
  if (!t_ns) ++short_messages_;
  const std::optional<LogTime> time = t_ns ? channel->clock.take(*t_ns) : std::optional<LogTime>();
  sink_.message(channel->id, time);
  if (!channel->wanted || !time || channel->type != LcmType::kTruth) return;
  if (!pass_truth(event.data, channel->id, *time, sink_)) ++short_messages_;
}

void LcmPass::report() {
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text);
  };
  warn(skipped_bytes_,
       "bytes in " + counted(damaged_places_, "place") +
           " belong to no complete event and were skipped");
  warn(short_messages_, "messages are shorter than their type and were left out");
  warn(left_out_events_,
       "events were left out: only " + std::to_string(kMaxChannels) + " channels are read");
  std::uint64_t implausible = 0;
  for (const auto& [key, channel] : channels_) implausible += channel.clock.implausible();
  warn(implausible, "stamps of messages are implausible and were not used");
}

}  // namespace

bool is_lcm_log(std::span<const std::uint8_t> head) {
  return event_at(head, std::uint64_t{1} << 32U).has_value();
}

Status read_lcm_log(ForwardReader& file, LogSink& sink) {
  LcmPass pass(sink);
  Status status = take_all_records(file, sink, [&]() -> Result<bool> {
    const Result<std::span<const std::uint8_t>> bytes = file.ahead(kEventWindowBytes);
    if (!bytes) return bytes.error();
    if (bytes->empty()) return false;
    const std::uint64_t step = pass.take(*bytes, file.size_bytes() - file.position());
    const Result<std::uint64_t> passed = pass_over(file, step, {});
    if (!passed) return passed.error();
    return true;
  });
  if (status) pass.report();
  return status;
}

}  // namespace overfly::flight::logs
