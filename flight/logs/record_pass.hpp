// Walks through a file of records.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Moves forward, at most to the end of the file.
/// @param seen  receives the bytes piece by piece; may be empty
/// @return the bytes that were there
/// Errors: kIo.
[[nodiscard]] Result<std::uint64_t> pass_over(
    ForwardReader& file,
    std::uint64_t bytes,
    const std::function<void(std::span<const std::uint8_t>)>& seen);

/// Takes one record after the other and reports the progress.
/// @param take_record  @return false at the end of what can be read
/// Errors: those of take_record; kCancelled if the sink stops.
[[nodiscard]] Status take_all_records(ForwardReader& file,
                                      LogSink& sink,
                                      const std::function<Result<bool>()>& take_record);

}  // namespace overfly::flight::logs
