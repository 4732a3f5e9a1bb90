#include "flight/logs/tlog/tlog_reader.hpp"

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "flight/logs/boot_clock.hpp"
#include "flight/logs/mode_names.hpp"
#include "flight/logs/tlog/tlog_streams.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::flight::logs {
namespace {

using mavlink::Frame;
using mavlink::MessageId;

constexpr std::size_t kStampBytes = 8;
/// A logged flight has some hundred streams; damaged bytes could make up to 2^32.
constexpr std::size_t kMaxStreams = 2048;
/// Bytes that surely hold a whole record.
constexpr std::size_t kReadAheadBytes = 4096;

std::uint64_t stamp_us(std::span<const std::uint8_t> prefix) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : prefix) value = (value << 8U) | byte;
  return value;
}

/// A fixed-wing aircraft (MAV_TYPE 1) or one that takes off vertically (19 to 25) with ArduPilot.
bool is_ardu_plane(const mavlink::Heartbeat& heartbeat) {
  const std::uint8_t type = heartbeat.vehicle_type;
  return heartbeat.autopilot == 3 && (type == 1 || (type >= 19 && type <= 25));
}

/// A component of a system, with a clock of its own.
struct Sender {
  std::string name;
  BootClock clock;
  std::optional<mavlink::Heartbeat> heartbeat;
  std::optional<std::uint16_t> mission_item;
  std::optional<LocalOrigin> origin;
  std::optional<StreamId> local_stream;
};

class TlogPass {
 public:
  explicit TlogPass(LogSink& sink) : sink_(sink) {}

  void take(const Frame& frame, std::span<const std::uint8_t> stamp);
  void report(const mavlink::FrameCounts& counts);

 private:
  struct Stream {
    StreamId id = 0;
    bool wanted = false;
  };

  Sender& sender_of(const Frame& frame);
  Stream* stream_of(const Frame& frame, Sender& sender);
  void take_origin(const Frame& frame, Sender& sender);
  void take_events(const Frame& frame, Sender& sender);
  void event(const Sender& sender, EventKind kind, std::string text);

  LogSink& sink_;
  std::unordered_map<std::uint64_t, Stream> streams_;
  std::unordered_map<std::uint32_t, Sender> senders_;
  std::uint64_t last_stamp_us_ = 0;
  std::uint64_t backward_stamps_ = 0;
  std::uint64_t left_out_messages_ = 0;
};

Sender& TlogPass::sender_of(const Frame& frame) {
  Sender& sender = senders_[(std::uint32_t{frame.system} << 8U) | frame.component];
  if (sender.name.empty()) sender.name = sender_name(frame);
  return sender;
}

TlogPass::Stream* TlogPass::stream_of(const Frame& frame, Sender& sender) {
  const std::uint64_t key = (std::uint64_t{frame.message_id} << 16U) |
                            (std::uint64_t{frame.system} << 8U) | frame.component;
  const auto known = streams_.find(key);
  if (known != streams_.end()) return &known->second;
  if (streams_.size() >= kMaxStreams) return nullptr;
  const StreamDescription description = describe_stream(frame);
  const auto id = static_cast<StreamId>(streams_.size());
  Stream& stream = streams_[key];
  stream = {id, sink_.stream(id, description)};
  if (description.position == PositionKind::kLocal) {
    sender.local_stream = id;
    if (sender.origin) sink_.local_origin(id, *sender.origin);
  }
  return &stream;
}

void TlogPass::take(const Frame& frame, std::span<const std::uint8_t> stamp) {
  const std::uint64_t received_us = stamp_us(stamp);
  if (received_us < last_stamp_us_) ++backward_stamps_;
  last_stamp_us_ = received_us;

  Sender& sender = sender_of(frame);
  Stream* const stream = stream_of(frame, sender);
  if (stream == nullptr) {
    ++left_out_messages_;
    return;
  }
  const std::optional<std::int64_t> boot_ns = mavlink::boot_time_ns(frame);
  const std::optional<LogTime> time = boot_ns ? sender.clock.take(*boot_ns) : sender.clock.latest();
  sink_.message(stream->id, time);
  if (stream->wanted && time) pass_samples(frame, stream->id, *time, sink_);
  take_origin(frame, sender);
  take_events(frame, sender);
}

void TlogPass::take_origin(const Frame& frame, Sender& sender) {
  if (static_cast<MessageId>(frame.message_id) != MessageId::kGpsGlobalOrigin) return;
  const mavlink::GlobalPosition position = mavlink::decode_gps_global_origin(frame);
  if (position.lat_deg == 0.0 && position.lon_deg == 0.0) return;
  const bool px4 = sender.heartbeat && sender.heartbeat->autopilot == 12;
  const LocalOrigin origin{position.lat_deg,
                           position.lon_deg,
                           position.alt_msl_m,
                           px4 ? LocalGrid::kPx4 : LocalGrid::kArduPilot};
  if (sender.origin != origin) sink_.declaration();
  sender.origin = origin;
  if (sender.local_stream) sink_.local_origin(*sender.local_stream, *sender.origin);
}

void TlogPass::event(const Sender& sender, EventKind kind, std::string text) {
  sink_.event({sender.name, sender.clock.latest(), kind, std::move(text)});
}

void TlogPass::take_events(const Frame& frame, Sender& sender) {
  const mavlink::PayloadReader payload(frame.payload);
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kHeartbeat: {
      const mavlink::Heartbeat now = mavlink::decode_heartbeat(frame);
      constexpr std::uint8_t kNoAutopilot = 8;  // ground stations, gimbals, cameras
      if (now.autopilot == kNoAutopilot) return;
      const std::optional<mavlink::Heartbeat> before = std::exchange(sender.heartbeat, now);
      if (!before || before->autopilot != now.autopilot) sink_.declaration();
      if (!before || before->custom_mode != now.custom_mode) {
        event(sender, EventKind::kMode, mode_text(now.custom_mode, is_ardu_plane(now)));
      }
      if (!before || before->armed() != now.armed()) {
        event(sender, EventKind::kArming, now.armed() ? "armed" : "disarmed");
      }
      return;
    }
    case MessageId::kStatusText:
      return event(sender, EventKind::kText, mavlink::decode_status_text(frame).text);
    case MessageId::kMissionCurrent: {
      const std::uint16_t item = mavlink::decode_mission_sequence(frame);
      if (std::exchange(sender.mission_item, item) != item) {
        event(sender, EventKind::kMission, "to mission item " + std::to_string(item));
      }
      return;
    }
    case MessageId::kMissionItemReached:
      return event(
          sender,
          EventKind::kMission,
          "reached mission item " + std::to_string(mavlink::decode_mission_sequence(frame)));
    case MessageId::kCameraTrigger:
      return event(
          sender, EventKind::kCamera, "trigger " + std::to_string(payload.at<std::uint32_t>(8)));
    case MessageId::kCameraFeedback:
      return event(
          sender, EventKind::kCamera, "image " + std::to_string(payload.at<std::uint16_t>(40)));
    default:
      return;
  }
}

void TlogPass::report(const mavlink::FrameCounts& counts) {
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text);
  };
  warn(counts.bad_checksums, "frames with a wrong checksum were left out");
  warn(counts.skipped_bytes, "bytes that belong to no valid frame were skipped");
  warn(counts.lost_messages, "messages are missing according to the sequence numbers");
  warn(backward_stamps_, "records were received before the one in front of them");
  warn(left_out_messages_,
       "messages were left out: only " + std::to_string(kMaxStreams) + " streams are read");
  std::uint64_t implausible = 0;
  for (const auto& [key, sender] : senders_) implausible += sender.clock.implausible();
  warn(implausible, "stamps of messages are implausible and were not used");
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
  TlogPass pass(sink);
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
      pass.take(*found.frame, found.prefix);
    }
    file.skip(used);
    if (!sink.progress(file.position())) {
      return Error{ErrorCode::kCancelled, "reading was cancelled"};
    }
  }
  pass.report(finder.counts());
  return {};
}

}  // namespace overfly::flight::logs
