#include "flight/logs/mcap/mcap_records.hpp"

#include "flight/logs/ros/ros_cursor.hpp"

namespace overfly::flight::logs {
namespace {

/// Numbers and texts of MCAP are laid out as those of ROS 1.
RosCursor fields_of(std::span<const std::uint8_t> content) {
  return {content, RosEncoding::kRos1, false};
}

}  // namespace

McapRecord mcap_record_at(std::span<const std::uint8_t> bytes) {
  RosCursor fields = fields_of(bytes);
  McapRecord record;
  record.opcode = static_cast<McapOpcode>(fields.number<std::uint8_t>());
  record.length = fields.number<std::uint64_t>();
  return record;
}

std::optional<McapSchema> mcap_schema_in(std::span<const std::uint8_t> content) {
  RosCursor fields = fields_of(content);
  McapSchema schema;
  schema.id = fields.number<std::uint16_t>();
  schema.name = fields.text();
  // Its definition is not needed: the types that are read have fixed ones.
  if (!fields.ok()) return std::nullopt;
  return schema;
}

std::optional<McapChannel> mcap_channel_in(std::span<const std::uint8_t> content) {
  RosCursor fields = fields_of(content);
  McapChannel channel;
  channel.id = fields.number<std::uint16_t>();
  channel.schema_id = fields.number<std::uint16_t>();
  channel.topic = fields.text();
  channel.message_encoding = fields.text();
  if (!fields.ok()) return std::nullopt;
  return channel;
}

std::optional<McapMessage> mcap_message_in(std::span<const std::uint8_t> content) {
  RosCursor fields = fields_of(content);
  McapMessage message;
  message.channel_id = fields.number<std::uint16_t>();
  (void)fields.number<std::uint32_t>();  // sequence
  message.log_time_ns = fields.number<std::uint64_t>();
  (void)fields.number<std::uint64_t>();  // publish_time
  if (!fields.ok()) return std::nullopt;
  message.data = content.subspan(kMcapMessageFieldBytes);
  return message;
}

std::optional<McapChunk> mcap_chunk_in(std::span<const std::uint8_t> content) {
  constexpr std::size_t kFixedBytes = 8 + 8 + 8 + 4 + 4 + 8;
  RosCursor fields = fields_of(content);
  McapChunk chunk;
  chunk.first_ns = fields.number<std::uint64_t>();
  chunk.last_ns = fields.number<std::uint64_t>();
  chunk.uncompressed_bytes = fields.number<std::uint64_t>();
  chunk.uncompressed_crc = fields.number<std::uint32_t>();
  chunk.compression = fields.text();
  chunk.stored_bytes = fields.number<std::uint64_t>();
  chunk.header_bytes = kFixedBytes + chunk.compression.size();
  if (!fields.ok()) return std::nullopt;
  return chunk;
}

std::optional<McapChunkIndex> mcap_chunk_index_in(std::span<const std::uint8_t> content) {
  RosCursor fields = fields_of(content);
  McapChunkIndex index;
  index.first_ns = fields.number<std::uint64_t>();
  index.last_ns = fields.number<std::uint64_t>();
  index.offset = fields.number<std::uint64_t>();
  index.length = fields.number<std::uint64_t>();
  (void)fields.octets();  // message_index_offsets: the message indexes themselves are read
  index.index_length = fields.number<std::uint64_t>();
  index.compression = fields.text();
  index.stored_bytes = fields.number<std::uint64_t>();
  index.uncompressed_bytes = fields.number<std::uint64_t>();
  if (!fields.ok()) return std::nullopt;
  return index;
}

std::optional<McapFooter> mcap_footer_in(std::span<const std::uint8_t> content) {
  RosCursor fields = fields_of(content);
  McapFooter footer;
  footer.summary_start = fields.number<std::uint64_t>();
  (void)fields.number<std::uint64_t>();  // summary_offset_start
  footer.summary_crc = fields.number<std::uint32_t>();
  if (!fields.ok()) return std::nullopt;
  return footer;
}

}  // namespace overfly::flight::logs
