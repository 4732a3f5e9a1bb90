// The events of an LCM event log.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

struct LcmEvent {
  std::int64_t recorded_us = 0;
  std::span<const std::uint8_t> channel;
  std::span<const std::uint8_t> data;  ///< or its start: at least 65 kB of it
  std::uint64_t data_bytes = 0;
  std::uint64_t data_at = 0;  ///< offset of the data in the file
  std::uint64_t bytes = 0;    ///< of the whole event
};

/// Whether the first bytes of a file are those of an LCM event log.
[[nodiscard]] bool is_lcm_log(std::span<const std::uint8_t> head);

/// Reads an LCM event log once, from start to end. Damaged bytes are skipped up to the next event
/// and reported in warnings.
/// @param take  receives each event; its bytes are valid during the call
/// Errors: kIo; kCancelled if the sink stops.
[[nodiscard]] Status read_lcm_events(ForwardReader& file,
                                     LogSink& sink,
                                     const std::function<void(const LcmEvent&)>& take);

}  // namespace overfly::flight::logs
