// The streams and events of a vehicle's MAVLink messages, from a recording or a live link.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>

#include "flight/logs/boot_clock.hpp"
#include "flight/logs/log_sink.hpp"
#include "flight/mavlink/messages.hpp"

namespace overfly::flight::logs {

/// Passes what MAVLink messages contain to a sink, with the times of the vehicle's clock: those of
/// the message, or of the latest message of the same component that has one.
class FrameStreams {
 public:
  explicit FrameStreams(LogSink& sink) : sink_(sink) {}

  void take(const mavlink::Frame& frame);
  /// Passes counts of what was left out to the sink, as warnings.
  void report();

 private:
  struct Stream {
    StreamId id = 0;
    bool wanted = false;
  };
  /// A component of a system, with a clock of its own.
  struct Sender {
    std::string name;
    BootClock clock;
    std::optional<mavlink::Heartbeat> heartbeat;
    std::optional<std::uint16_t> mission_item;
    std::optional<LocalOrigin> origin;
    std::optional<StreamId> local_stream;
  };

  Sender& sender_of(const mavlink::Frame& frame);
  Stream* stream_of(const mavlink::Frame& frame, Sender& sender);
  void take_origin(const mavlink::Frame& frame, Sender& sender);
  void take_events(const mavlink::Frame& frame, Sender& sender);
  void event(const Sender& sender, EventKind kind, std::string text);

  LogSink& sink_;
  std::unordered_map<std::uint64_t, Stream> streams_;
  std::unordered_map<std::uint32_t, Sender> senders_;
  std::uint64_t left_out_messages_ = 0;
};

}  // namespace overfly::flight::logs
