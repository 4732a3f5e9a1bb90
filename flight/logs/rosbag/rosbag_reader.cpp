// After "Bags/Format/2.0" of the ROS wiki.
#include "flight/logs/rosbag/rosbag_reader.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/text/printable_text.hpp"
#include "core/time.hpp"
#include "flight/logs/record_pass.hpp"
#include "flight/logs/ros/chunk_reader.hpp"
#include "flight/logs/ros/ros_topics.hpp"
#include "flight/logs/rosbag/bag_records.hpp"

namespace overfly::flight::logs {
namespace {

/// Bytes of a record that are looked at: its header and the start of its data.
constexpr std::size_t kBagWindowBytes = 2 * kMaxBagHeaderBytes + 64;
constexpr std::size_t kMaxConnections = 65536;
constexpr std::size_t kMaxTopicBytes = 512;

class RosbagPass {
 public:
  RosbagPass(ForwardReader& file, LogSink& sink, RosMessageSink& topics)
      : file_(file), sink_(sink), topics_(topics) {}

  Status run();

 private:
  /// @return false at the end of what can be read
  Result<bool> take_record();
  Status skip(std::uint64_t bytes);
  /// @pre the position is that of the chunk's data
  Status take_chunk(std::string_view compression, std::uint32_t stored, std::uint32_t declared);
  /// @param whole  the records end with these bytes
  void take_records(std::span<const std::uint8_t> bytes, bool whole, MessagePlace chunk);
  /// Connections and messages, in chunks and outside of them.
  /// @param data  or its start
  /// @param place  of the data
  void take(const BagRecord& record, std::span<const std::uint8_t> data, const MessagePlace& place);
  void take_connection(const BagRecord& record, std::span<const std::uint8_t> data);
  void take_message(const BagRecord& record,
                    std::span<const std::uint8_t> data,
                    const MessagePlace& place);
  void report();

  ForwardReader& file_;
  LogSink& sink_;
  RosMessageSink& topics_;
  ChunkReader chunks_;
  std::unordered_map<std::uint32_t, std::optional<RosMessageSink::Topic>> connections_;
  bool indexed_ = false;
  std::uint64_t damaged_chunks_ = 0;
  std::uint64_t large_chunks_ = 0;
  std::uint64_t unknown_compressions_ = 0;
  std::uint64_t cut_records_ = 0;
  std::uint64_t bad_records_ = 0;
  std::uint64_t without_connection_ = 0;
  std::uint64_t unread_bytes_ = 0;
};

Status RosbagPass::skip(std::uint64_t bytes) {
  const Result<std::uint64_t> passed = pass_over(file_, bytes, {});
  return passed ? Status() : passed.error();
}

void RosbagPass::take_connection(const BagRecord& record, std::span<const std::uint8_t> data) {
  const std::optional<std::uint32_t> id = bag_number(record.header, "conn");
  const std::string_view topic = bag_text(record.header, "topic");
  const std::string_view type = bag_text(data, "type");
  if (!id || topic.empty() || topic.size() > kMaxTopicBytes || type.size() > kMaxTopicBytes ||
      connections_.size() >= kMaxConnections) {
    ++bad_records_;
    return;
  }
  // The index at the end of the bag repeats the connections.
  if (connections_.contains(*id)) return;
  sink_.declaration();
  connections_[*id] = topics_.add(std::string(topic), type, RosEncoding::kRos1);
}

void RosbagPass::take_message(const BagRecord& record,
                              std::span<const std::uint8_t> data,
                              const MessagePlace& place) {
  const std::optional<std::uint32_t> id = bag_number(record.header, "conn");
  const auto time = bag_field(record.header, "time");
  if (!id || !time || time->size() != 8) {
    ++bad_records_;
    return;
  }
  const auto connection = connections_.find(*id);
  if (connection == connections_.end()) {
    ++without_connection_;
    return;
  }
  RosCursor fields(*time, RosEncoding::kRos1, false);
  const std::uint64_t seconds = fields.number<std::uint32_t>();
  const std::uint64_t recorded_ns =
      seconds * static_cast<std::uint64_t>(kNsPerS) + fields.number<std::uint32_t>();
  if (connection->second) topics_.take(*connection->second, data, recorded_ns, place);
}

void RosbagPass::take(const BagRecord& record,
                      std::span<const std::uint8_t> data,
                      const MessagePlace& place) {
  if (record.op() == BagOp::kConnection) take_connection(record, data);
  if (record.op() == BagOp::kMessage) take_message(record, data, place);
}

void RosbagPass::take_records(std::span<const std::uint8_t> bytes, bool whole, MessagePlace chunk) {
  while (!bytes.empty()) {
    bool impossible = false;
    const std::optional<BagRecord> record = bag_record_at(bytes, &impossible);
    if (!record || record->data_bytes > bytes.size() - record->data_at) {
      ++(whole || impossible ? bad_records_ : cut_records_);
      return;
    }
    const std::uint64_t begin = chunk.offset;
    chunk.offset += record->data_at;
    chunk.bytes = record->data_bytes;
    take(*record, bytes.subspan(record->data_at, record->data_bytes), chunk);
    chunk.offset = begin + record->data_at + record->data_bytes;
    bytes = bytes.subspan(record->data_at + record->data_bytes);
  }
}

Status RosbagPass::take_chunk(std::string_view compression,
                              std::uint32_t stored,
                              std::uint32_t declared) {
  const std::optional<ChunkCompression> known = chunk_compression_named(compression);
  // A recorder fills in the lengths when it ends a chunk.
  const bool unfinished = stored == 0 && declared == 0;
  if (!known || *known == ChunkCompression::kZstd) {
    ++unknown_compressions_;
    return skip(stored);
  }
  // The records of an unfinished chunk without compression follow as if they
  // were outside of it.
  if (unfinished && *known == ChunkCompression::kNone) return {};
  if (declared > ChunkReader::kMaxBytes) {
    ++large_chunks_;
    return skip(stored);
  }
  const std::uint64_t rest = file_.size_bytes() - file_.position();
  const ChunkPlace place{file_.file_offset(),
                         unfinished ? rest : stored,
                         *known,
                         unfinished ? ChunkReader::kMaxBytes : declared};
  const Result<ChunkReader::Chunk> chunk =
      chunks_.read(file_, place.stored_bytes, *known, place.declared_bytes, {});
  if (!chunk) return chunk.error();
  if (chunk->damaged && !unfinished) {
    ++damaged_chunks_;
  } else {
    if ((chunk->cut || unfinished) && chunk->bytes.empty()) ++cut_records_;
    take_records(chunk->bytes, !chunk->cut && !unfinished, {place, 0, 0});
  }
  return {};
}

Result<bool> RosbagPass::take_record() {
  const Result<std::span<const std::uint8_t>> ahead = file_.ahead(kBagWindowBytes);
  if (!ahead) return ahead.error();
  if (ahead->empty()) return false;
  const std::uint64_t left = file_.size_bytes() - file_.position();
  bool impossible = false;
  const std::optional<BagRecord> record = bag_record_at(*ahead, &impossible);
  const bool chunk = record && record->op() == BagOp::kChunk;
  const bool cut = record && record->data_bytes > left - record->data_at;
  if (!record || (cut && !chunk)) {
    if (impossible) unread_bytes_ = left;
    if (!impossible) ++cut_records_;
    return false;
  }
  const std::size_t shown =
      std::min<std::size_t>(record->data_bytes, ahead->size() - record->data_at);
  if (record->op() == BagOp::kFileHeader) {
    const std::string_view encryptor = bag_text(record->header, "encryptor");
    if (!encryptor.empty()) {
      return Error{ErrorCode::kUnsupported, "the bag is encrypted, which is not supported"};
    }
    const auto index = bag_field(record->header, "index_pos");
    indexed_ = index && std::any_of(index->begin(), index->end(), [](std::uint8_t byte) {
                 return byte != 0;
               });
  }
  Status status;
  if (chunk) {
    // Copied, because the fields do not outlive the next bytes.
    const std::string compression(bag_text(record->header, "compression"));
    const std::uint32_t declared = bag_number(record->header, "size").value_or(0);
    const std::uint32_t stored = record->data_bytes;
    file_.skip(record->data_at);
    status = take_chunk(compression, stored, declared);
  } else {
    take(*record,
         ahead->subspan(record->data_at, shown),
         {std::nullopt, file_.file_offset() + record->data_at, record->data_bytes});
    status = skip(record->data_at + std::uint64_t{record->data_bytes});
  }
  if (!status) return status.error();
  return true;
}

void RosbagPass::report() {
  topics_.report();
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text);
  };
  warn(damaged_chunks_, "chunks cannot be decompressed or have wrong lengths, and were left out");
  warn(large_chunks_, "chunks are larger than 128 MiB and were left out");
  warn(unknown_compressions_,
       "chunks are compressed in a way that is not read "
       "(only lz4 and bz2 are) and were left out");
  warn(cut_records_, "records are cut off by the end of the file");
  warn(bad_records_, "records have wrong lengths or lack fields, and were left out");
  warn(unread_bytes_, "bytes at the end belong to no record and were not read");
  warn(without_connection_, "messages belong to no connection");
  if (!indexed_) {
    sink_.warning("the recording was not closed: it was read up to the end of the file");
  }
}

Status RosbagPass::run() {
  if (Status status = skip(kBagMagic.size()); !status) return status;
  Status status = take_all_records(file_, sink_, [this] { return take_record(); });
  if (status) report();
  return status;
}

}  // namespace

bool is_rosbag(std::span<const std::uint8_t> head) {
  return head.size() >= kBagMagic.size() &&
         std::equal(kBagMagic.begin(), kBagMagic.end(), head.begin(), [](char a, std::uint8_t b) {
           return static_cast<std::uint8_t>(a) == b;
         });
}

Status read_rosbag_messages(ForwardReader& file, LogSink& sink, RosMessageSink& messages) {
  return RosbagPass(file, sink, messages).run();
}

Status read_rosbag(ForwardReader& file, LogSink& sink) {
  RosTopics topics(sink);
  return read_rosbag_messages(file, sink, topics);
}

}  // namespace overfly::flight::logs
