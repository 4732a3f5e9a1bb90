// The streams and events of a vehicle's MAVLink messages, from a recording or a live link.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "flight/logs/boot_clock.hpp"
#include "flight/logs/held_messages.hpp"
#include "flight/logs/log_sink.hpp"
#include "flight/mavlink/messages.hpp"

namespace overfly::flight::logs {

/// Passes what MAVLink messages contain to a sink, with the times of the vehicle's clock: those of
/// the message, or of the latest message of the same component that has one. Events before a
/// component's first time are held, and get that time: the vehicle was in that mode when it came.
/// Messages without a time that come while stamps suggest that the clock has started again are held
/// until these are believed or not: they belong to the run of the stamp in front of them.
class FrameStreams {
 public:
  explicit FrameStreams(LogSink& sink) : sink_(sink) {}

  void take(const mavlink::Frame& frame);
  /// The frame whose content is being passed to the sink: the one that was taken, or one that was
  /// held. @pre the sink is being called with a message, a sample or an event
  [[nodiscard]] const mavlink::Frame& passing() const { return *passing_; }
  /// Passes on what is still held, and counts of what was left out as warnings.
  void report();

 private:
  struct Stream {
    StreamId id = 0;
    bool wanted = false;
    bool sensors = false;
  };
  /// A frame whose payload points nowhere, and its payload.
  struct HeldFrame {
    mavlink::Frame frame;
    std::vector<std::uint8_t> payload;
  };
  /// A message without a time, behind a stamp that may begin another run of the clock.
  struct DoubtfulFrame {
    HeldFrame held;
    std::optional<LogTime> time;  ///< if the stamp was wrong
    BootClock::Suspicion suspicion;
  };
  /// A component of a system, with a clock of its own.
  struct Sender {
    std::string name;
    BootClock clock;
    HeldMessages<HeldFrame> held;
    std::vector<DoubtfulFrame> doubtful;                            ///< at most kMostHeld
    std::vector<std::pair<EventKind, std::string>> untimed_events;  ///< before its first time
    std::optional<mavlink::Heartbeat> heartbeat;
    std::optional<std::uint16_t> mission_item;
    std::optional<LocalOrigin> origin;
    std::optional<StreamId> local_stream;
  };

  Sender& sender_of(const mavlink::Frame& frame);
  Stream* stream_of(const mavlink::Frame& frame, Sender& sender);
  void pass(const mavlink::Frame& frame,
            const std::optional<LogTime>& time,
            const Stream& stream,
            Sender& sender);
  void pass_held(Sender& sender);
  void pass(const HeldFrame& held, const std::optional<LogTime>& time, Sender& sender);
  void pass_doubtful(Sender& sender);
  void pass_sensors(const mavlink::Frame& frame,
                    StreamId id,
                    const LogTime& time,
                    const Sender& sender);
  void take_origin(const mavlink::Frame& frame, Sender& sender);
  void take_events(const mavlink::Frame& frame, const std::optional<LogTime>& time, Sender& sender);
  void pass_untimed_events(Sender& sender, const std::optional<LogTime>& time);

  LogSink& sink_;
  const mavlink::Frame* passing_ = nullptr;
  std::unordered_map<std::uint64_t, Stream> streams_;
  std::unordered_map<std::uint32_t, Sender> senders_;
  std::uint64_t left_out_messages_ = 0;
};

}  // namespace overfly::flight::logs
