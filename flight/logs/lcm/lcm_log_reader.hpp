// Reads event logs of LCM.
#pragma once

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Reads an LCM event log once, from start to end. LCM is not needed.
///
/// A stream is a channel. The types of Overfly's own messages (middleware/lcm/types) are recognised
/// by their fingerprints, whatever the channel is called: truth_t gives positions and attitudes,
/// the other types with a field t_ns are listed with it. Messages of other types are listed with
/// the time of recording. Damaged bytes are skipped up to the next event and reported in warnings.
/// Errors: kIo; kCancelled if the sink stops.
[[nodiscard]] Status read_lcm_log(ForwardReader& file, LogSink& sink);

}  // namespace overfly::flight::logs
