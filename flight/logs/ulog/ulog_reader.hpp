// Reads PX4's ULog files (.ulg), which declare their own messages.
#pragma once

#include <cstdint>
#include <span>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Whether the first bytes of a file are those of a ULog file.
[[nodiscard]] bool is_ulog(std::span<const std::uint8_t> head);

/// Reads a ULog file once, from start to end, with its appended data.
///
/// A stream is a topic with its instance: "vehicle_attitude[0]". Times are the field `timestamp`.
/// Damaged bytes are skipped up to the next two messages of known kinds and reported in warnings,
/// as are the dropouts that the logger recorded itself.
/// Errors: kIo; kUnsupported for a file whose flags demand a newer reader; kCancelled if the sink
/// stops.
[[nodiscard]] Status read_ulog(ForwardReader& file, LogSink& sink);

}  // namespace overfly::flight::logs
