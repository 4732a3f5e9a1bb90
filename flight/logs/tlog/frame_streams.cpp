#include "flight/logs/tlog/frame_streams.hpp"

#include <utility>

#include "flight/logs/mode_names.hpp"
#include "flight/logs/tlog/tlog_streams.hpp"
#include "flight/mavlink/payload.hpp"
#include "flight/mavlink/sensor_messages.hpp"

namespace overfly::flight::logs {
namespace {

/// A logged flight has some hundred streams; damaged bytes could make up to 2^32.
constexpr std::size_t kMaxStreams = 2048;
/// Of a component; further ones are passed on without a time.
constexpr std::size_t kMaxUntimedEvents = 256;

}  // namespace

using mavlink::Frame;
using mavlink::MessageId;

FrameStreams::Sender& FrameStreams::sender_of(const Frame& frame) {
  Sender& sender = senders_[(std::uint32_t{frame.system} << 8U) | frame.component];
  if (sender.name.empty()) sender.name = sender_name(frame);
  return sender;
}

FrameStreams::Stream* FrameStreams::stream_of(const Frame& frame, Sender& sender) {
  const std::uint64_t key = (std::uint64_t{frame.message_id} << 16U) |
                            (std::uint64_t{frame.system} << 8U) | frame.component;
  const auto known = streams_.find(key);
  if (known != streams_.end()) return &known->second;
  if (streams_.size() >= kMaxStreams) return nullptr;
  const StreamDescription description = describe_stream(frame);
  const auto id = static_cast<StreamId>(streams_.size());
  Stream& stream = streams_[key];
  stream = {id, sink_.stream(id, description), description.sensors};
  if (description.position == PositionKind::kLocal) {
    sender.local_stream = id;
    if (sender.origin) sink_.local_origin(id, *sender.origin);
  }
  return &stream;
}

void FrameStreams::take(const Frame& frame) {
  Sender& sender = sender_of(frame);
  Stream* const stream = stream_of(frame, sender);
  if (stream == nullptr) {
    ++left_out_messages_;
    return;
  }
  const std::optional<std::int64_t> boot_ns = mavlink::boot_time_ns(frame);
  const std::optional<LogTime> time = boot_ns ? sender.clock.take(*boot_ns) : sender.clock.latest();
  const auto suspicion = sender.clock.suspicion();
  if (!suspicion) pass_doubtful(sender);
  if (sender.held.must_hold(sender.clock)) {
    sink_.declaration();
    sender.held.hold(time, {frame, {frame.payload.begin(), frame.payload.end()}});
    return;
  }
  pass_held(sender);
  if (suspicion && !boot_ns) {
    if (sender.doubtful.size() == kMostHeld) pass_doubtful(sender);
    sink_.declaration();
    sender.doubtful.push_back(
        {{frame, {frame.payload.begin(), frame.payload.end()}}, time, *suspicion});
    return;
  }
  pass(frame, time, *stream, sender);
}

void FrameStreams::pass_held(Sender& sender) {
  sender.held.release(sender.clock,
                      [&](const auto& time, const HeldFrame& held) { pass(held, time, sender); });
}

void FrameStreams::pass(const HeldFrame& held, const std::optional<LogTime>& time, Sender& sender) {
  Frame frame = held.frame;
  frame.payload = held.payload;
  pass(frame, time, *stream_of(frame, sender), sender);
}

void FrameStreams::pass_doubtful(Sender& sender) {
  for (const DoubtfulFrame& doubtful : std::exchange(sender.doubtful, {})) {
    const bool believed = doubtful.suspicion.number == sender.clock.believed_suspicion();
    const LogTime in_its_run{sender.clock.latest()->boot, doubtful.suspicion.t_ns};
    pass(doubtful.held, believed ? in_its_run : doubtful.time, sender);
  }
}

void FrameStreams::pass(const Frame& frame,
                        const std::optional<LogTime>& time,
                        const Stream& stream,
                        Sender& sender) {
  passing_ = &frame;
  sink_.message(stream.id, time);
  if (time && !sender.untimed_events.empty()) pass_untimed_events(sender, time);
  if (stream.wanted && time) {
    pass_samples(frame, stream.id, *time, sink_);
    if (stream.sensors) pass_sensors(frame, stream.id, *time, sender);
  }
  take_origin(frame, sender);
  take_events(frame, time, sender);
}

void FrameStreams::pass_untimed_events(Sender& sender, const std::optional<LogTime>& time) {
  for (auto& [kind, text] : std::exchange(sender.untimed_events, {})) {
    sink_.event({sender.name, time, kind, std::move(text)});
  }
}

void FrameStreams::pass_sensors(const Frame& frame,
                                StreamId id,
                                const LogTime& time,
                                const Sender& sender) {
  const std::uint8_t autopilot = sender.heartbeat ? sender.heartbeat->autopilot : std::uint8_t{0};
  const auto measured = mavlink::sensor_samples_of(frame, {time.t_ns, autopilot, 0.0});
  if (measured) sink_.samples(id, time, measured->preference, measured->samples);
}

void FrameStreams::take_origin(const Frame& frame, Sender& sender) {
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

void FrameStreams::take_events(const Frame& frame,
                               const std::optional<LogTime>& time,
                               Sender& sender) {
  const auto event = [&](EventKind kind, std::string text) {
    if (!time && sender.untimed_events.size() < kMaxUntimedEvents) {
      sink_.declaration();
      sender.untimed_events.emplace_back(kind, std::move(text));
    } else {
      sink_.event({sender.name, time ? time : sender.clock.latest(), kind, std::move(text)});
    }
  };
  const mavlink::PayloadReader payload(frame.payload);
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kHeartbeat: {
      const mavlink::Heartbeat now = mavlink::decode_heartbeat(frame);
      if (!now.is_autopilot()) return;
      const std::optional<mavlink::Heartbeat> before = std::exchange(sender.heartbeat, now);
      if (!before || before->autopilot != now.autopilot) sink_.declaration();
      if (!before || before->custom_mode != now.custom_mode) {
        event(EventKind::kMode, mode_text(now.custom_mode, now.is_ardu_plane()));
      }
      if (!before || before->armed() != now.armed()) {
        event(EventKind::kArming, now.armed() ? "armed" : "disarmed");
      }
      return;
    }
    case MessageId::kStatusText:
      return event(EventKind::kText, mavlink::decode_status_text(frame).text);
    case MessageId::kMissionCurrent: {
      const std::uint16_t item = mavlink::decode_mission_sequence(frame);
      if (std::exchange(sender.mission_item, item) != item) {
        event(EventKind::kMission, "to mission item " + std::to_string(item));
      }
      return;
    }
    case MessageId::kMissionItemReached:
      return event(
          EventKind::kMission,
          "reached mission item " + std::to_string(mavlink::decode_mission_sequence(frame)));
    case MessageId::kCameraTrigger:
      return event(EventKind::kCamera, "trigger " + std::to_string(payload.at<std::uint32_t>(8)));
    case MessageId::kCameraFeedback:
      return event(EventKind::kCamera, "image " + std::to_string(payload.at<std::uint16_t>(40)));
    default:
      return;
  }
}

void FrameStreams::report() {
  for (auto& [key, sender] : senders_) {
    pass_held(sender);
    pass_doubtful(sender);
    pass_untimed_events(sender, std::nullopt);
  }
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text);
  };
  warn(left_out_messages_,
       "messages were left out: only " + std::to_string(kMaxStreams) + " streams are read");
  std::uint64_t implausible = 0;
  for (const auto& [key, sender] : senders_) implausible += sender.clock.implausible();
  warn(implausible, "stamps of messages are implausible and were not used");
}

}  // namespace overfly::flight::logs
