// What each MAVLink message contributes to a flight log. Private to tlog.
#pragma once

#include <cstdint>
#include <string>

#include "flight/logs/log_sink.hpp"
#include "flight/mavlink/frame.hpp"

namespace overfly::flight::logs {

/// The description of the stream of a frame's message and sender.
[[nodiscard]] StreamDescription describe_stream(const mavlink::Frame& frame);

/// "1.1": system and component of a sender.
[[nodiscard]] std::string sender_name(const mavlink::Frame& frame);

/// Passes the position and attitude of a frame on.
void pass_samples(const mavlink::Frame& frame, StreamId id, const LogTime& time, LogSink& sink);

}  // namespace overfly::flight::logs
