// Reads MCAP files (.mcap) with messages of ROS 1 and ROS 2.
#pragma once

#include <cstdint>
#include <span>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "flight/logs/log_sink.hpp"
#include "flight/logs/ros/message_sink.hpp"

namespace overfly::flight::logs {

/// Whether the first bytes of a file are those of an MCAP file of version 0.
[[nodiscard]] bool is_mcap(std::span<const std::uint8_t> head);

/// Reads an MCAP file once, from start to the end of its data.
///
/// A stream is a topic. Read are the message encodings `ros1` and `cdr`, chunks without compression
/// and those with `lz4` and `zstd`; channels of other encodings are listed. A recording that was
/// cut off is read up to the last whole message, also within its last chunk. Chunks with a wrong
/// checksum are left out. What was left out is reported in warnings.
/// Errors: kIo; kCancelled if the sink stops.
[[nodiscard]] Status read_mcap(ForwardReader& file, LogSink& sink);

/// Numbers of what was left out of a file.
struct McapFaults {
  std::uint64_t bad_checksums = 0;  ///< chunks
  std::uint64_t damaged_chunks = 0;
  std::uint64_t large_chunks = 0;
  std::uint64_t unknown_compressions = 0;  ///< chunks
  std::uint64_t cut_records = 0;
  std::uint64_t bad_records = 0;
  std::uint64_t without_channel = 0;  ///< messages
  friend bool operator==(const McapFaults&, const McapFaults&) = default;
};

/// As read_mcap, with the messages for another receiver: `sink` gets warnings and progress only.
/// @param faults  may be null
[[nodiscard]] Status read_mcap_messages(ForwardReader& file,
                                        LogSink& sink,
                                        RosMessageSink& messages,
                                        McapFaults* faults = nullptr);

}  // namespace overfly::flight::logs
