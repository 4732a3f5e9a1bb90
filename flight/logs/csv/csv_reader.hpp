// Reads the CSV files of a mapping as one flight log.
#pragma once

#include <filesystem>

#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "flight/logs/csv/csv_mapping.hpp"
#include "flight/logs/log_sink.hpp"

namespace overfly::flight::logs {

/// Passes the rows of every piece to a sink, one piece after another: a piece is a stream. Each
/// piece has a clock of its own with the mapping's offset, see BootClock.
///
/// Rows that cannot be used are left out, and a warning for each kind counts them: another number
/// of fields than the header (a half last line), no readable time, the time of the row before, an
/// implausible time, a field that is blank or not a number. Values that are not finite or out of
/// range and rows that the mapping marks as invalid are invalid samples of the stream. Angles are
/// in range up to 360 deg, pitch up to 90 deg.
/// Memory: one buffer, whatever the size of the files.
/// @param sources  which files the mapping may name
/// Errors: as read_csv_mapping and SourcePolicy::check, naming "pieces.N.file"; kUnreadable for a
/// piece without a header or without a column of the mapping; kIo; kCancelled.
[[nodiscard]] Status read_csv_log(const std::filesystem::path& mapping,
                                  const SourcePolicy& sources,
                                  LogSink& sink);

}  // namespace overfly::flight::logs
