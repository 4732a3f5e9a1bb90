#include "server/export/mcap/mcap_file.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <concepts>
#include <cstring>
#include <utility>

#include "server/files/build_info.hpp"

namespace overfly::server {
namespace {

/// A chunk ends when it has this many bytes; one image may make it larger.
constexpr std::size_t kChunkBytes = std::size_t{4} << 20U;
constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

/// Kinds of records ("Records" in the specification).
enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

template <std::integral T>
void put_number(McapBytes& bytes, T value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

void put_counted(McapBytes& bytes, std::string_view text) {
  put_number(bytes, static_cast<std::uint32_t>(text.size()));
  bytes.insert(bytes.end(), text.begin(), text.end());
}

void put_all(McapBytes& bytes, std::span<const std::uint8_t> more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

void put_record(McapBytes& bytes, Opcode opcode, const McapBytes& content) {
  put_number(bytes, static_cast<std::uint8_t>(opcode));
  put_number(bytes, std::uint64_t{content.size()});
  put_all(bytes, content);
}

/// A map from channels to numbers, with its length in bytes in front.
void put_map(McapBytes& bytes, const std::map<McapFile::ChannelId, std::uint64_t>& map) {
  constexpr std::size_t kPairBytes = 10;
  put_number(bytes, static_cast<std::uint32_t>(map.size() * kPairBytes));
  for (const auto& [channel, value] : map) {
    put_number(bytes, channel);
    put_number(bytes, value);
  }
}

std::uint32_t crc_after(std::uint32_t crc, std::span<const std::uint8_t> bytes) {
  return libdeflate_crc32(crc, bytes.data(), bytes.size());
}

}  // namespace

Result<McapFile> McapFile::create(const std::filesystem::path& file, std::string_view profile) {
  Result<AppendFile> opened = AppendFile::create(file);
  if (!opened) return opened.error();
  McapFile mcap(std::move(opened).value());
  McapBytes header;
  put_counted(header, profile);
  put_counted(header, "overfly " + std::string(version()));
  McapBytes bytes(kMagic.begin(), kMagic.end());
  put_record(bytes, Opcode::kHeader, header);
  if (Status status = mcap.write(bytes); !status) return status.error();
  return mcap;
}

Status McapFile::write(const McapBytes& bytes) {
  at_ += bytes.size();
  crc_ = crc_after(crc_, bytes);
  return file_.append(std::span<const std::uint8_t>(bytes));
}

McapFile::ChannelId McapFile::add_channel(const std::string& topic,
                                          const std::string& type,
                                          std::string_view definition) {
  const auto [schema, added] =
      schemas_.try_emplace(type, static_cast<std::uint16_t>(schemas_.size() + 1));
  McapBytes declared;
  if (added) {
    McapBytes content;
    put_number(content, schema->second);
    put_counted(content, type);
    put_counted(content, "ros2msg");
    put_counted(content, definition);
    put_record(declared, Opcode::kSchema, content);
    put_all(schema_records_, declared);
  }
  const auto id = static_cast<ChannelId>(message_counts_.size());
  message_counts_[id] = 0;
  McapBytes content;
  put_number(content, id);
  put_number(content, schema->second);
  put_counted(content, topic);
  put_counted(content, "cdr");
  put_number(content, std::uint32_t{0});  // no metadata
  McapBytes channel;
  put_record(channel, Opcode::kChannel, content);
  put_all(channel_records_, channel);
  put_all(records_, declared);
  put_all(records_, channel);
  return id;
}

Status McapFile::add_message(ChannelId channel,
                             std::uint64_t log_time_ns,
                             std::span<const std::uint8_t> data) {
  const std::uint64_t offset = records_.size();
  const std::uint64_t sequence = message_counts_[channel]++;
  put_number(records_, static_cast<std::uint8_t>(Opcode::kMessage));
  put_number(records_, std::uint64_t{22 + data.size()});
  put_number(records_, channel);
  put_number(records_, static_cast<std::uint32_t>(sequence));
  put_number(records_, log_time_ns);
  put_number(records_, log_time_ns);  // publish_time
  put_all(records_, data);
  const bool first = message_index_.empty();
  chunk_.first_ns = first ? log_time_ns : std::min(chunk_.first_ns, log_time_ns);
  chunk_.last_ns = std::max(chunk_.last_ns, log_time_ns);
  put_number(message_index_[channel], log_time_ns);
  put_number(message_index_[channel], offset);
  return records_.size() < kChunkBytes ? Status() : end_chunk();
}

Status McapFile::end_chunk() {
  if (records_.empty()) return {};
  chunk_.offset = at_;
  chunk_.record_bytes = records_.size();
  McapBytes bytes;
  constexpr std::size_t kFieldBytes = 8 + 8 + 8 + 4 + 4 + 8;
  put_number(bytes, static_cast<std::uint8_t>(Opcode::kChunk));
  put_number(bytes, std::uint64_t{kFieldBytes + records_.size()});
  put_number(bytes, chunk_.first_ns);
  put_number(bytes, chunk_.last_ns);
  put_number(bytes, std::uint64_t{records_.size()});
  put_number(bytes, crc_after(0, records_));
  put_counted(bytes, "");  // compression
  put_number(bytes, std::uint64_t{records_.size()});
  put_all(bytes, records_);
  chunk_.bytes = bytes.size();
  for (const auto& [channel, entries] : message_index_) {
    chunk_.index_offsets[channel] = at_ + bytes.size();
    McapBytes content;
    put_number(content, channel);
    put_number(content, static_cast<std::uint32_t>(entries.size()));
    put_all(content, entries);
    put_record(bytes, Opcode::kMessageIndex, content);
  }
  chunk_.index_bytes = bytes.size() - chunk_.bytes;
  chunks_.push_back(std::exchange(chunk_, {}));
  records_.clear();
  message_index_.clear();
  return write(bytes);
}

McapBytes McapFile::summary() const {
  McapBytes statistics;
  std::uint64_t messages = 0;
  for (const auto& [channel, count] : message_counts_) messages += count;
  std::uint64_t first_ns = chunks_.empty() ? 0 : chunks_.front().first_ns;
  std::uint64_t last_ns = 0;
  McapBytes chunk_indexes;
  for (const ChunkEntry& chunk : chunks_) {
    first_ns = std::min(first_ns, chunk.first_ns);
    last_ns = std::max(last_ns, chunk.last_ns);
    McapBytes content;
    put_number(content, chunk.first_ns);
    put_number(content, chunk.last_ns);
    put_number(content, chunk.offset);
    put_number(content, chunk.bytes);
    put_map(content, chunk.index_offsets);
    put_number(content, chunk.index_bytes);
    put_counted(content, "");
    put_number(content, chunk.record_bytes);
    put_number(content, chunk.record_bytes);
    put_record(chunk_indexes, Opcode::kChunkIndex, content);
  }
  put_number(statistics, messages);
  put_number(statistics, static_cast<std::uint16_t>(schemas_.size()));
  put_number(statistics, static_cast<std::uint32_t>(message_counts_.size()));
  put_number(statistics, std::uint32_t{0});  // attachments
  put_number(statistics, std::uint32_t{0});  // metadata
  put_number(statistics, static_cast<std::uint32_t>(chunks_.size()));
  put_number(statistics, first_ns);
  put_number(statistics, last_ns);
  put_map(statistics, message_counts_);
  McapBytes statistics_record;
  put_record(statistics_record, Opcode::kStatistics, statistics);

  McapBytes bytes;
  McapBytes offsets;
  const std::pair<Opcode, const McapBytes*> groups[] = {{Opcode::kSchema, &schema_records_},
                                                        {Opcode::kChannel, &channel_records_},
                                                        {Opcode::kStatistics, &statistics_record},
                                                        {Opcode::kChunkIndex, &chunk_indexes}};
  for (const auto& [opcode, group] : groups) {
    if (group->empty()) continue;
    McapBytes content;
    put_number(content, static_cast<std::uint8_t>(opcode));
    put_number(content, at_ + bytes.size());
    put_number(content, std::uint64_t{group->size()});
    put_record(offsets, Opcode::kSummaryOffset, content);
    put_all(bytes, *group);
  }
  const std::uint64_t offsets_at = at_ + bytes.size();
  put_all(bytes, offsets);
  // The checksum covers the summary and the footer up to itself.
  put_number(bytes, static_cast<std::uint8_t>(Opcode::kFooter));
  put_number(bytes, std::uint64_t{20});
  put_number(bytes, at_);
  put_number(bytes, offsets_at);
  put_number(bytes, crc_after(0, bytes));
  put_all(bytes, McapBytes(kMagic.begin(), kMagic.end()));
  return bytes;
}

Status McapFile::close() {
  if (Status status = end_chunk(); !status) return status;
  McapBytes content;
  put_number(content, crc_);
  McapBytes end;
  put_record(end, Opcode::kDataEnd, content);
  if (Status status = write(end); !status) return status;
  return write(summary());
}

}  // namespace overfly::server
