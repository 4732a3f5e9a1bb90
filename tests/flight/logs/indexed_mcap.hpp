// MCAP files with chunks, message indexes and a summary, made by hand and spoiled at will.
#pragma once

#include <libdeflate.h>

#include <cstdint>
#include <vector>

#include "core/time.hpp"
#include "tests/flight/logs/ros_bytes.hpp"

namespace overfly::flight::testing {

/// A chunk index as it will be written.
struct IndexedChunk {
  std::uint64_t first_ns = 0;
  std::uint64_t last_ns = 0;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t index_length = 0;
  std::uint64_t size = 0;
};

class IndexedMcap {
 public:
  IndexedMcap() : bytes(mcap_start("ros2")) {}

  /// @param channels  of its messages
  void add_chunk(const Bytes& records,
                 std::int64_t first_ns,
                 std::int64_t last_ns,
                 const std::vector<std::uint16_t>& channels,
                 bool right_crc = true) {
    IndexedChunk chunk;
    chunk.first_ns = static_cast<std::uint64_t>(first_ns);
    chunk.last_ns = static_cast<std::uint64_t>(last_ns);
    chunk.offset = bytes.size();
    chunk.size = records.size();
    const std::uint32_t crc = libdeflate_crc32(0, records.data(), records.size());
    append(
        bytes,
        mcap_chunk(
            records, records.size(), right_crc ? crc : crc + 1, "", chunk.first_ns, chunk.last_ns));
    chunk.length = bytes.size() - chunk.offset;
    for (const std::uint16_t channel : channels) {
      Bytes content;
      put(content, channel);
      put(content, std::uint32_t{16});
      content.resize(content.size() + 16);
      append(bytes, mcap_record(0x07, content));
    }
    chunk.index_length = bytes.size() - chunk.offset - chunk.length;
    chunks.push_back(chunk);
  }

  /// The end of the data, the summary with `declarations`, and the footer.
  void finish(const Bytes& declarations, bool right_crc = true) {
    append(bytes, mcap_record(0x0F, Bytes(4, 0)));
    const std::uint64_t summary_start = bytes.size();
    Bytes summary = declarations;
    for (const IndexedChunk& chunk : chunks) {
      Bytes content;
      for (const std::uint64_t value :
           {chunk.first_ns, chunk.last_ns, chunk.offset, chunk.length}) {
        put(content, value);
      }
      put(content, std::uint32_t{0});  // no offsets of message indexes
      put(content, chunk.index_length);
      put(content, std::uint32_t{0});  // no compression
      put(content, chunk.size);
      put(content, chunk.size);
      append(summary, mcap_record(0x08, content));
    }
    Bytes footer;
    put(footer, summary_start);
    put(footer, std::uint64_t{0});
    put(footer, std::uint32_t{0});
    append(summary, mcap_record(0x02, footer));
    summary.resize(summary.size() - 4);
    const std::uint32_t crc = libdeflate_crc32(0, summary.data(), summary.size());
    put(summary, right_crc ? crc : crc + 1);
    append(bytes, summary);
    put_text(bytes, "\x89MCAP0\r\n", 8);
  }

  Bytes bytes;
  std::vector<IndexedChunk> chunks;  ///< may be spoiled before finish()
};

}  // namespace overfly::flight::testing
