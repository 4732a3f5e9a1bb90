// The records of MCAP files as values. Private to mcap.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace overfly::flight::logs {

/// Numbers of the kinds of records ("MCAP File Format Specification", "Records").
enum class McapOpcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kDataEnd = 0x0F,
};

inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);
/// Kind (1 byte) and length (8 bytes) in front of each record.
inline constexpr std::size_t kMcapRecordHeaderBytes = 9;

struct McapRecord {
  McapOpcode opcode{};
  std::uint64_t length = 0;  ///< of the content
};
/// @pre at least kMcapRecordHeaderBytes
[[nodiscard]] McapRecord mcap_record_at(std::span<const std::uint8_t> bytes);

// Each is empty if the content ends early.

struct McapSchema {
  std::uint16_t id = 0;
  std::string name;
};
[[nodiscard]] std::optional<McapSchema> mcap_schema_in(std::span<const std::uint8_t> content);

struct McapChannel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;  ///< 0: no schema
  std::string topic;
  std::string message_encoding;
};
[[nodiscard]] std::optional<McapChannel> mcap_channel_in(std::span<const std::uint8_t> content);

struct McapMessage {
  std::uint16_t channel_id = 0;
  std::uint64_t log_time_ns = 0;
  std::span<const std::uint8_t> data;
};
/// The fields in front of a message's data.
inline constexpr std::size_t kMcapMessageFieldBytes = 22;
[[nodiscard]] std::optional<McapMessage> mcap_message_in(std::span<const std::uint8_t> content);

/// A chunk's fields in front of its stored bytes.
struct McapChunk {
  std::uint64_t first_ns = 0;  ///< times of recording; 0 without messages
  std::uint64_t last_ns = 0;
  std::uint64_t uncompressed_bytes = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0: none
  std::string compression;
  std::uint64_t stored_bytes = 0;
  std::size_t header_bytes = 0;  ///< length of these fields
};
[[nodiscard]] std::optional<McapChunk> mcap_chunk_in(std::span<const std::uint8_t> content);
/// No chunk has longer fields: the name of a compression is short.
inline constexpr std::size_t kMcapChunkHeaderBytes = 4096;

/// What the summary says about a chunk.
struct McapChunkIndex {
  std::uint64_t first_ns = 0;
  std::uint64_t last_ns = 0;
  std::uint64_t offset = 0;        ///< of the chunk's record in the file
  std::uint64_t length = 0;        ///< of the whole record
  std::uint64_t index_length = 0;  ///< of the message indexes that follow it
  std::string compression;
  std::uint64_t stored_bytes = 0;
  std::uint64_t uncompressed_bytes = 0;
};
[[nodiscard]] std::optional<McapChunkIndex> mcap_chunk_index_in(
    std::span<const std::uint8_t> content);

struct McapFooter {
  std::uint64_t summary_start = 0;  ///< 0: there is no summary
  std::uint32_t summary_crc = 0;    ///< 0: none
};
inline constexpr std::size_t kMcapFooterBytes = 20;
[[nodiscard]] std::optional<McapFooter> mcap_footer_in(std::span<const std::uint8_t> content);

}  // namespace overfly::flight::logs
