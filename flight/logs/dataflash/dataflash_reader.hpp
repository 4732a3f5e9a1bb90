// Reads ArduPilot's DataFlash logs (.bin), which declare their own records.
#pragma once

#include <cstdint>
#include <span>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Whether the first bytes of a file are those of a DataFlash log: among them is a FMT record.
[[nodiscard]] bool is_dataflash(std::span<const std::uint8_t> head);

/// Reads a DataFlash log once, from start to end.
///
/// A stream is the records of one name, and of one instance if they count equal sensors or cores:
/// "XKF1[0]". Times are TimeUS or, in old logs, TimeMS.
/// A record is accepted if another one, or the end of the file, follows it: records have no
/// checksum. Other bytes are skipped up to the next such record and reported in warnings.
/// Local positions of XKF1, NKF1 and EKF1 count from the ORGN record of type 0. Those of SIM2 count
/// from the simulator's start, which is found by comparison with SIM.
/// Errors: kIo; kCancelled if the sink stops.
[[nodiscard]] Status read_dataflash(ForwardReader& file, LogSink& sink);

}  // namespace overfly::flight::logs
