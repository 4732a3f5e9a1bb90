// Reads .tlog files: MAVLink frames, each after the time at which it was received.
#pragma once

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Whether the first bytes of a file are those of a .tlog: among them is a time stamp of 8 bytes,
/// big-endian microseconds since 1970, and a MAVLink frame with a right checksum.
[[nodiscard]] bool is_tlog(std::span<const std::uint8_t> head);

/// Reads a .tlog once, from start to end.
///
/// A stream is the messages of one id from one component: "1.1/ATTITUDE" (system 1, component 1).
/// Times are those of the vehicle's clock that the messages contain (time_boot_ms, time_usec). A
/// message without such a field, e.g. SIM_STATE, gets the time of the latest message of the same
/// component that has one: an autopilot sends both in one pass of its loop. The time of reception
/// is not used.
/// Damaged bytes are skipped up to the next valid frame and reported in warnings.
/// Errors: kIo; kCancelled if the sink stops.
[[nodiscard]] Status read_tlog(ForwardReader& file, LogSink& sink);

}  // namespace overfly::flight::logs
