#include "flight/logs/mcap/mcap_parts.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "core/cancel.hpp"
#include "core/time.hpp"
#include "flight/logs/mcap/mcap_reader.hpp"
#include "flight/logs/mcap/mcap_summary.hpp"
#include "flight/logs/ros/ros_messages.hpp"

namespace overfly::flight::logs {
namespace {

/// Between a message's stamp and its recording.
constexpr std::int64_t kMostDelayNs = 2 * kNsPerS;
/// Chunks in which a topic's first messages are: BootClock proves a clock by four stamps.
constexpr int kFirstChunks = 4;
constexpr std::size_t kSampledChunks = 16;
constexpr std::uint64_t kMaxSampledBytes = std::uint64_t{64} << 20U;

/// What lies between the indexed chunks declares something: nobody knows what is there.
LogIndex index_of(const McapSummary& summary, std::uint64_t size_bytes) {
  LogIndex index;
  std::uint64_t at = 0;
  const auto fill_to = [&](std::uint64_t offset, bool declares) {
    if (offset > at) index.push_back({{at, offset}, {}, {}, declares});
    at = std::max(at, offset);
  };
  std::map<std::uint16_t, int> seen;
  for (const McapIndexedChunk& chunk : summary.chunks) {
    fill_to(chunk.index.offset, true);
    bool declares = chunk.channels.empty();
    for (const std::uint16_t channel : chunk.channels) {
      declares = ++seen[channel] <= kFirstChunks || declares;
    }
    at = chunk.index.offset + chunk.index.length + chunk.index.index_length;
    LogBlock block{{chunk.index.offset, at}, {}, {}, declares};
    if (!chunk.channels.empty()) {
      constexpr std::int64_t kLatest = std::numeric_limits<std::int64_t>::max() - kMostDelayNs;
      block.first_ns = static_cast<std::int64_t>(chunk.index.first_ns) - kMostDelayNs;
      block.last_ns =
          std::min(static_cast<std::int64_t>(chunk.index.last_ns), kLatest) + kMostDelayNs;
    }
    index.push_back(block);
  }
  fill_to(summary.data_end, true);
  fill_to(size_bytes, false);
  return index;
}

/// Marks chunks from the whole file as needed.
LogIndex with_samples(LogIndex index) {
  std::uint64_t bytes = 0;
  const std::size_t step = std::max<std::size_t>(1, index.size() / kSampledChunks);
  for (std::size_t i = step / 2; i < index.size(); i += step) {
    LogBlock& block = index[i];
    bytes += block.bytes.end - block.bytes.begin;
    if (bytes > kMaxSampledBytes) break;
    block.declares = block.declares || block.first_ns;
  }
  return index;
}

std::uint64_t bytes_of(const std::vector<FileRange>& parts) {
  std::uint64_t bytes = 0;
  for (const FileRange& part : parts) bytes += part.end - part.begin;
  return bytes;
}

/// Compares stamps, times of recording and times of chunks.
class StampCheck final : public RosMessageSink {
 public:
  explicit StampCheck(const McapSummary& summary) : summary_(summary) {}

  std::optional<Topic> add(const std::string& /*name*/,
                           std::string_view type,
                           RosEncoding encoding) override {
    topics_.push_back(
        {encoding == RosEncoding::kOther ? RosType::kOther : ros_type_named(type), encoding});
    return topics_.size() - 1;
  }
  void take(Topic topic,
            std::span<const std::uint8_t> data,
            std::uint64_t recorded_ns,
            const MessagePlace& place) override {
    if (place.chunk) check_chunk(*place.chunk, recorded_ns);
    const TopicType& type = topics_[topic];
    if (type.type == RosType::kOther) return;
    std::optional<RosCursor> message = ros_cursor_of(data, type.encoding);
    if (!message) return;
    const std::int64_t stamp_ns = take_header(*message).stamp_ns;
    if (!message->ok()) return;
    constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    const bool near = recorded_ns <= kMost && stamp_ns >= 0 &&
                      std::abs(stamp_ns - static_cast<std::int64_t>(recorded_ns)) <= kMostDelayNs;
    stamps_agree_ = stamps_agree_ && near;
  }
  void report() override {}

  /// Empty if nothing is wrong.
  [[nodiscard]] std::string fault() const {
    if (topics_.size() < summary_.channels.size()) {
      return "channels are not declared where their messages are";
    }
    if (!chunks_agree_) return "a chunk has messages outside of its times";
    if (!stamps_agree_) return "stamps are more than 2 s away from the times of recording";
    return "";
  }

 private:
  struct TopicType {
    RosType type = RosType::kOther;
    RosEncoding encoding = RosEncoding::kOther;
  };

  void check_chunk(const ChunkPlace& place, std::uint64_t recorded_ns) {
    if (place.file_offset != chunk_at_) {
      chunk_at_ = place.file_offset;
      const auto behind = std::upper_bound(
          summary_.chunks.begin(),
          summary_.chunks.end(),
          chunk_at_,
          [](std::uint64_t at, const McapIndexedChunk& chunk) { return at < chunk.index.offset; });
      // Messages in chunks without an index are read in any case.
      chunk_ = nullptr;
      if (behind != summary_.chunks.begin()) {
        const McapChunkIndex& index = std::prev(behind)->index;
        if (chunk_at_ < index.offset + index.length) chunk_ = &index;
      }
    }
    if (chunk_ == nullptr) return;
    chunks_agree_ =
        chunks_agree_ && recorded_ns >= chunk_->first_ns && recorded_ns <= chunk_->last_ns;
  }

  const McapSummary& summary_;
  std::vector<TopicType> topics_;
  std::uint64_t chunk_at_ = 0;
  const McapChunkIndex* chunk_ = nullptr;
  bool stamps_agree_ = true;
  bool chunks_agree_ = true;
};

/// Takes nothing; may be cancelled.
class CancelSink final : public LogSink {
 public:
  explicit CancelSink(const std::atomic<bool>* cancel) : cancel_(cancel) {}

  [[nodiscard]] bool stream(StreamId /*id*/, const StreamDescription& /*description*/) override {
    return false;
  }
  void message(StreamId /*id*/, const std::optional<LogTime>& /*time*/) override {}
  void local_origin(StreamId /*id*/, const LocalOrigin& /*origin*/) override {}
  void event(LogEvent /*event*/) override {}
  void warning(const std::string& /*text*/) override {}
  [[nodiscard]] bool progress(std::uint64_t /*bytes*/) override { return !is_cancelled(cancel_); }

 private:
  void take_position(StreamId /*id*/,
                     const LogTime& /*time*/,
                     const Eigen::Vector3d& /*value*/) override {}
  void take_attitude(StreamId /*id*/,
                     const LogTime& /*time*/,
                     const Eigen::Quaterniond& /*R_ned_body*/) override {}
  void take_invalid(StreamId /*id*/) override {}
  [[nodiscard]] PositionKind position_kind(StreamId /*id*/) const override {
    return PositionKind::kNone;
  }

  const std::atomic<bool>* cancel_;
};

}  // namespace

Result<std::vector<FileRange>> mcap_parts_for(const std::filesystem::path& file,
                                              const LogSlice& slice,
                                              const std::atomic<bool>* cancel) {
  const Result<ReadableFile> readable = ReadableFile::open(file);
  if (!readable) return readable.error();
  const Result<std::uint64_t> size = readable->size_bytes();
  if (!size) return size.error();
  const Result<McapSummary> summary = read_mcap_summary(*readable);
  if (!summary) return summary.error();
  const LogIndex index = index_of(*summary, *size);
  const std::vector<FileRange> parts = parts_for(index, slice);
  if (bytes_of(parts) > *size / 2) return std::vector<FileRange>();
  Result<ForwardReader> reader = ForwardReader::open(file);
  if (!reader) return reader.error();
  reader->only(parts_for(with_samples(index), slice));
  CancelSink sink(cancel);
  StampCheck check(*summary);
  McapFaults faults;
  if (Status status = read_mcap_messages(*reader, sink, check, &faults); !status) {
    return status.error();
  }
  if (faults != McapFaults()) return Error{ErrorCode::kUnreadable, "chunks or records are damaged"};
  if (const std::string fault = check.fault(); !fault.empty()) {
    return Error{ErrorCode::kUnreadable, fault};
  }
  return parts;
}

}  // namespace overfly::flight::logs
