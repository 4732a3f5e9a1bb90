// After the "MCAP File Format Specification" (major version 0).
#include "flight/logs/mcap/mcap_reader.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/text/printable_text.hpp"
#include "flight/logs/mcap/mcap_records.hpp"
#include "flight/logs/record_pass.hpp"
#include "flight/logs/ros/chunk_reader.hpp"
#include "flight/logs/ros/ros_topics.hpp"

namespace overfly::flight::logs {
namespace {

/// Bytes of a record that are looked at: a message with its fields, a topic with its names.
constexpr std::size_t kRecordBytes = 2 * RosMessageSink::kMessageBytes;
/// Schemas and channels that damaged or hostile bytes could declare are limited by 16 bit numbers;
/// their names by this.
constexpr std::size_t kMaxNameBytes = 512;

class McapPass {
 public:
  McapPass(ForwardReader& file, LogSink& sink, RosMessageSink& topics)
      : file_(file), sink_(sink), topics_(topics) {}

  Status run();
  [[nodiscard]] const McapFaults& faults() const { return faults_; }

 private:
  [[nodiscard]] Status skip(std::uint64_t bytes);
  void count_crc(std::span<const std::uint8_t> bytes) {
    crc_ = libdeflate_crc32(crc_, bytes.data(), bytes.size());
  }
  /// @return false at the end of what can be read
  Result<bool> take_record();
  Status take_chunk(std::uint64_t length);
  /// Schemas, channels and messages, in chunks and outside of them.
  /// @param content  or its start
  /// @param place  of the content
  void take(McapOpcode opcode, std::span<const std::uint8_t> content, MessagePlace place);
  /// @param whole  the records end with these bytes
  void take_records(std::span<const std::uint8_t> bytes, bool whole, MessagePlace chunk);
  void take_channel(const McapChannel& channel);
  void take_message(const McapMessage& message, const MessagePlace& place);
  void check_data(std::span<const std::uint8_t> content, std::uint32_t crc);
  void report();

  ForwardReader& file_;
  LogSink& sink_;
  RosMessageSink& topics_;
  ChunkReader chunks_;
  std::unordered_map<std::uint16_t, std::string> schemas_;
  std::unordered_map<std::uint16_t, std::optional<RosMessageSink::Topic>> channels_;
  std::uint32_t crc_ = 0;  ///< of the file so far
  bool ended_ = false;     ///< the end of the data was met
  McapFaults faults_;
  bool bad_data_checksum_ = false;
};

Status McapPass::skip(std::uint64_t bytes) {
  const Result<std::uint64_t> passed =
      pass_over(file_, bytes, [this](std::span<const std::uint8_t> seen) { count_crc(seen); });
  return passed ? Status() : passed.error();
}

void McapPass::take_channel(const McapChannel& channel) {
  RosEncoding encoding = RosEncoding::kOther;
  if (channel.message_encoding == "ros1") encoding = RosEncoding::kRos1;
  if (channel.message_encoding == "cdr") encoding = RosEncoding::kCdr;
  const auto schema = schemas_.find(channel.schema_id);
  const std::string type = schema == schemas_.end() ? "" : schema->second;
  // A channel with the same number must be identical: the first one counts.
  if (channels_.contains(channel.id)) return;
  sink_.declaration();
  channels_[channel.id] = topics_.add(channel.topic, type, encoding);
}

void McapPass::take_message(const McapMessage& message, const MessagePlace& place) {
  const auto channel = channels_.find(message.channel_id);
  if (channel == channels_.end()) {
    ++faults_.without_channel;
  } else if (channel->second) {
    topics_.take(*channel->second, message.data, message.log_time_ns, place);
  }
}

void McapPass::take(McapOpcode opcode, std::span<const std::uint8_t> content, MessagePlace place) {
  bool ok = true;
  if (opcode == McapOpcode::kSchema) {
    std::optional<McapSchema> schema = mcap_schema_in(content);
    ok = schema && schema->name.size() <= kMaxNameBytes;
    if (ok && schema->id != 0 && schemas_.try_emplace(schema->id, std::move(schema->name)).second) {
      sink_.declaration();
    }
  } else if (opcode == McapOpcode::kChannel) {
    const std::optional<McapChannel> channel = mcap_channel_in(content);
    ok = channel && channel->topic.size() <= kMaxNameBytes;
    if (ok) take_channel(*channel);
  } else if (opcode == McapOpcode::kMessage) {
    const std::optional<McapMessage> message = mcap_message_in(content);
    ok = message.has_value();
    if (ok) {
      place.offset += kMcapMessageFieldBytes;
      place.bytes -= kMcapMessageFieldBytes;
      take_message(*message, place);
    }
  }
  if (!ok) ++faults_.bad_records;
}

void McapPass::take_records(std::span<const std::uint8_t> bytes, bool whole, MessagePlace chunk) {
  while (!bytes.empty()) {
    const bool has_header = bytes.size() >= kMcapRecordHeaderBytes;
    const McapRecord record = has_header ? mcap_record_at(bytes) : McapRecord{};
    const std::size_t left = has_header ? bytes.size() - kMcapRecordHeaderBytes : 0;
    if (!has_header || record.length > left) {
      ++(whole ? faults_.bad_records : faults_.cut_records);
      return;
    }
    const auto length = static_cast<std::size_t>(record.length);
    chunk.offset += kMcapRecordHeaderBytes;
    chunk.bytes = length;
    take(record.opcode, bytes.subspan(kMcapRecordHeaderBytes, length), chunk);
    chunk.offset += length;
    bytes = bytes.subspan(kMcapRecordHeaderBytes + length);
  }
}

/// @pre the record's header was skipped
Status McapPass::take_chunk(std::uint64_t length) {
  const Result<std::span<const std::uint8_t>> ahead = file_.ahead(kMcapChunkHeaderBytes);
  if (!ahead) return ahead.error();
  const auto shown = static_cast<std::size_t>(std::min<std::uint64_t>(length, ahead->size()));
  const std::optional<McapChunk> chunk = mcap_chunk_in(ahead->first(shown));
  if (!chunk) {
    ++(ahead->size() < kMcapChunkHeaderBytes && length > shown ? faults_.cut_records
                                                               : faults_.damaged_chunks);
    return skip(length);
  }
  const std::optional<ChunkCompression> compression = chunk_compression_named(chunk->compression);
  const bool supported = compression && *compression != ChunkCompression::kBz2;
  const bool large = chunk->uncompressed_bytes > ChunkReader::kMaxBytes;
  const bool fits = chunk->stored_bytes == length - chunk->header_bytes;
  if (!supported || large || !fits) {
    ++(!supported ? faults_.unknown_compressions
       : large    ? faults_.large_chunks
                  : faults_.damaged_chunks);
    return skip(length);
  }
  if (Status status = skip(chunk->header_bytes); !status) return status;
  const MessagePlace place{
      ChunkPlace{file_.file_offset(), chunk->stored_bytes, *compression, chunk->uncompressed_bytes},
      0,
      0};
  const Result<ChunkReader::Chunk> read =
      chunks_.read(file_,
                   chunk->stored_bytes,
                   *compression,
                   chunk->uncompressed_bytes,
                   [this](std::span<const std::uint8_t> stored) { count_crc(stored); });
  if (!read) return read.error();
  if (read->damaged) {
    ++faults_.damaged_chunks;
  } else if (!read->cut && chunk->uncompressed_crc != 0 &&
             libdeflate_crc32(0, read->bytes.data(), read->bytes.size()) !=
                 chunk->uncompressed_crc) {
    ++faults_.bad_checksums;
  } else {
    if (read->cut && read->bytes.empty()) ++faults_.cut_records;
    take_records(read->bytes, !read->cut, place);
  }
  return {};
}

Result<bool> McapPass::take_record() {
  const Result<std::span<const std::uint8_t>> ahead = file_.ahead(kRecordBytes);
  if (!ahead) return ahead.error();
  if (ahead->empty()) return false;
  const bool has_header = ahead->size() >= kMcapRecordHeaderBytes;
  const McapRecord record = has_header ? mcap_record_at(*ahead) : McapRecord{};
  const std::uint64_t left = file_.size_bytes() - file_.position() - kMcapRecordHeaderBytes;
  if (!has_header || (record.length > left && record.opcode != McapOpcode::kChunk)) {
    ++faults_.cut_records;
    return false;
  }
  const auto shown = static_cast<std::size_t>(
      std::min<std::uint64_t>(record.length, ahead->size() - kMcapRecordHeaderBytes));
  const std::span<const std::uint8_t> content = ahead->subspan(kMcapRecordHeaderBytes, shown);
  if (record.opcode == McapOpcode::kFooter || record.opcode == McapOpcode::kDataEnd) {
    ended_ = true;
    if (record.opcode == McapOpcode::kDataEnd) check_data(content, crc_);
    return false;
  }
  if (record.opcode != McapOpcode::kChunk) {
    take(record.opcode,
         content,
         {std::nullopt, file_.file_offset() + kMcapRecordHeaderBytes, record.length});
    if (Status status = skip(kMcapRecordHeaderBytes + record.length); !status) {
      return status.error();
    }
    return true;
  }
  Status status = skip(kMcapRecordHeaderBytes);
  if (status) status = take_chunk(record.length);
  if (!status) return status.error();
  return true;
}

/// The data section's checksum covers the file from its first byte.
void McapPass::check_data(std::span<const std::uint8_t> content, std::uint32_t crc) {
  RosCursor fields(content, RosEncoding::kRos1, false);
  const auto stated = fields.number<std::uint32_t>();
  bad_data_checksum_ = fields.ok() && stated != 0 && stated != crc;
}

void McapPass::report() {
  topics_.report();
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text);
  };
  warn(faults_.bad_checksums, "chunks have a wrong checksum and were left out");
  warn(faults_.damaged_chunks,
       "chunks cannot be decompressed or have wrong lengths, and were left out");
  warn(faults_.large_chunks, "chunks are larger than 128 MiB and were left out");
  warn(faults_.unknown_compressions,
       "chunks are compressed in a way that is not read (only lz4 and zstd are) and were left out");
  warn(faults_.cut_records, "records are cut off by the end of the file");
  warn(faults_.bad_records, "records have wrong lengths and were left out");
  warn(faults_.without_channel, "messages belong to no channel");
  if (bad_data_checksum_) sink_.warning("the checksum of the data section is wrong");
  if (!ended_) sink_.warning("the recording has no end: it was read up to the end of the file");
}

Status McapPass::run() {
  if (Status status = skip(kMcapMagic.size()); !status) return status;
  Status status = take_all_records(file_, sink_, [this] { return take_record(); });
  if (status) report();
  return status;
}

}  // namespace

bool is_mcap(std::span<const std::uint8_t> head) {
  return head.size() >= kMcapMagic.size() &&
         std::equal(kMcapMagic.begin(), kMcapMagic.end(), head.begin(), [](char a, std::uint8_t b) {
           return static_cast<std::uint8_t>(a) == b;
         });
}

Status read_mcap_messages(ForwardReader& file,
                          LogSink& sink,
                          RosMessageSink& messages,
                          McapFaults* faults) {
  McapPass pass(file, sink, messages);
  Status status = pass.run();
  if (faults != nullptr) *faults = pass.faults();
  return status;
}

Status read_mcap(ForwardReader& file, LogSink& sink) {
  RosTopics topics(sink);
  return read_mcap_messages(file, sink, topics);
}

}  // namespace overfly::flight::logs
