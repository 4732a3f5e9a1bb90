// The summary of an MCAP file, compared with the file. Private to mcap.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "core/outside/file_text.hpp"
#include "core/result.hpp"
#include "flight/logs/mcap/mcap_records.hpp"

namespace overfly::flight::logs {

/// A chunk with the message indexes that follow it.
struct McapIndexedChunk {
  McapChunkIndex index;
  std::vector<std::uint16_t> channels;  ///< with messages in it, as its message indexes say
};

struct McapSummary {
  std::uint64_t data_end = 0;            ///< of the record that ends the data
  std::vector<McapIndexedChunk> chunks;  ///< by offset, without overlaps
  std::set<std::uint16_t> channels;      ///< of the file
};

/// Larger summaries are not read.
inline constexpr std::uint64_t kMaxMcapSummaryBytes = std::uint64_t{64} << 20U;

/// Reads the summary, the header of each chunk and the headers of the message indexes.
///
/// Offsets and lengths lie within the data, without overlaps; at each offset there is a chunk of
/// the stated length, times, compression and sizes, and behind it message indexes of the stated
/// length. Times fit in 63 bits, the first is not behind the last.
/// Errors: kNotFound without a summary; kUnreadable saying what is wrong; kIo.
[[nodiscard]] Result<McapSummary> read_mcap_summary(const ReadableFile& file);

}  // namespace overfly::flight::logs
