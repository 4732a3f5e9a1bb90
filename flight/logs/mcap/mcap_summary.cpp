// After the "MCAP File Format Specification": "Footer", "Summary Section", "Chunk Index".
#include "flight/logs/mcap/mcap_summary.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

namespace overfly::flight::logs {
namespace {

constexpr std::size_t kFooterRecordBytes = kMcapRecordHeaderBytes + kMcapFooterBytes;
/// The record that ends the data: its content is a checksum.
constexpr std::size_t kDataEndBytes = kMcapRecordHeaderBytes + 4;
/// A chunk's record header, its fields, and a name of a compression.
constexpr std::size_t kChunkStartBytes = kMcapRecordHeaderBytes + 8 + 8 + 8 + 4 + 4 + 64 + 8;
/// Message indexes that are looked at: one for each channel of a chunk.
constexpr std::size_t kMaxMessageIndexes = 2'000'000;

Error wrong(const std::string& what) { return {ErrorCode::kUnreadable, what}; }

std::string at_text(const McapChunkIndex& index) {
  return "the chunk index of offset " + std::to_string(index.offset);
}

/// The record's header at an offset. @pre the file has that many bytes
Result<McapRecord> record_at(const ReadableFile& file, std::uint64_t offset) {
  std::array<std::uint8_t, kMcapRecordHeaderBytes> bytes{};
  if (Status status = file.read_at(offset, bytes); !status) return status.error();
  return mcap_record_at(bytes);
}

struct SummaryBytes {
  std::uint64_t data_end = 0;
  std::vector<std::uint8_t> records;
};

Result<SummaryBytes> read_summary_bytes(const ReadableFile& file) {
  const Result<std::uint64_t> size = file.size_bytes();
  if (!size) return size.error();
  constexpr std::uint64_t kEndBytes = kFooterRecordBytes + kMcapMagic.size();
  if (*size < kMcapMagic.size() + kDataEndBytes + kEndBytes) {
    return Error{ErrorCode::kNotFound, "it has no end"};
  }
  std::array<std::uint8_t, kEndBytes> end{};
  if (Status status = file.read_at(*size - kEndBytes, end); !status) return status.error();
  const McapRecord record = mcap_record_at(end);
  const auto footer =
      mcap_footer_in(std::span(end).subspan(kMcapRecordHeaderBytes, kMcapFooterBytes));
  const bool has_magic =
      std::equal(kMcapMagic.begin(),
                 kMcapMagic.end(),
                 end.end() - kMcapMagic.size(),
                 [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
  if (!has_magic || record.opcode != McapOpcode::kFooter || record.length != kMcapFooterBytes) {
    return Error{ErrorCode::kNotFound, "it has no end"};
  }
  if (footer->summary_start == 0) return Error{ErrorCode::kNotFound, "it has no summary"};
  const std::uint64_t footer_at = *size - kEndBytes;
  if (footer->summary_start < kMcapMagic.size() + kDataEndBytes ||
      footer->summary_start > footer_at) {
    return wrong("its summary lies outside of the file");
  }
  const std::uint64_t length = footer_at - footer->summary_start;
  if (length > kMaxMcapSummaryBytes) return wrong("its summary is larger than 64 MiB");
  SummaryBytes summary;
  summary.data_end = footer->summary_start - kDataEndBytes;
  const Result<McapRecord> data_end = record_at(file, summary.data_end);
  if (!data_end) return data_end.error();
  if (data_end->opcode != McapOpcode::kDataEnd || data_end->length != 4) {
    return wrong("its summary does not begin behind the end of the data");
  }
  summary.records.resize(length);
  if (Status status = file.read_at(footer->summary_start, summary.records); !status) {
    return status.error();
  }
  // The checksum covers the footer up to itself.
  std::uint32_t crc = libdeflate_crc32(0, summary.records.data(), summary.records.size());
  crc = libdeflate_crc32(crc, end.data(), kFooterRecordBytes - 4);
  if (footer->summary_crc != 0 && crc != footer->summary_crc) {
    return wrong("its summary has a wrong checksum");
  }
  return summary;
}

Result<McapSummary> summary_in(const SummaryBytes& bytes) {
  McapSummary summary;
  summary.data_end = bytes.data_end;
  std::span<const std::uint8_t> rest = bytes.records;
  while (!rest.empty()) {
    const bool has_header = rest.size() >= kMcapRecordHeaderBytes;
    const McapRecord record = has_header ? mcap_record_at(rest) : McapRecord{};
    if (!has_header || record.length > rest.size() - kMcapRecordHeaderBytes) {
      return wrong("a record of its summary has a wrong length");
    }
    const auto content =
        rest.subspan(kMcapRecordHeaderBytes, static_cast<std::size_t>(record.length));
    rest = rest.subspan(kMcapRecordHeaderBytes + content.size());
    if (record.opcode == McapOpcode::kChannel) {
      const std::optional<McapChannel> channel = mcap_channel_in(content);
      if (!channel) return wrong("a channel of its summary is cut off");
      summary.channels.insert(channel->id);
    } else if (record.opcode == McapOpcode::kChunkIndex) {
      std::optional<McapChunkIndex> index = mcap_chunk_index_in(content);
      if (!index) return wrong("a chunk index is cut off");
      summary.chunks.push_back({std::move(*index), {}});
    }
  }
  if (summary.chunks.empty())
    return Error{ErrorCode::kNotFound, "its summary has no chunk indexes"};
  std::sort(summary.chunks.begin(), summary.chunks.end(), [](const auto& a, const auto& b) {
    return a.index.offset < b.index.offset;
  });
  return summary;
}

/// The chunks lie one behind the other within the data.
Status check_places(const McapSummary& summary) {
  std::uint64_t end = kMcapMagic.size();
  for (const McapIndexedChunk& chunk : summary.chunks) {
    const McapChunkIndex& index = chunk.index;
    if (index.offset < end) return wrong(at_text(index) + " overlaps what is in front of it");
    const std::uint64_t room = summary.data_end - std::min(summary.data_end, index.offset);
    if (index.length > room || index.index_length > room - index.length) {
      return wrong(at_text(index) + " reaches beyond the data");
    }
    constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    if (index.first_ns > index.last_ns || index.last_ns > kMost) {
      return wrong(at_text(index) + " has impossible times");
    }
    end = index.offset + index.length + index.index_length;
  }
  return {};
}

Status check_chunk(const ReadableFile& file, const McapChunkIndex& index) {
  std::array<std::uint8_t, kChunkStartBytes> bytes{};
  const Result<std::size_t> got = file.read_some(index.offset, bytes);
  if (!got) return got.error();
  if (*got < kMcapRecordHeaderBytes) return wrong(at_text(index) + " lies at the end of the file");
  const McapRecord record = mcap_record_at(bytes);
  const auto chunk = mcap_chunk_in(std::span(bytes).first(*got).subspan(kMcapRecordHeaderBytes));
  const bool agrees =
      record.opcode == McapOpcode::kChunk && chunk && index.length >= kMcapRecordHeaderBytes &&
      record.length == index.length - kMcapRecordHeaderBytes && chunk->first_ns == index.first_ns &&
      chunk->last_ns == index.last_ns && chunk->compression == index.compression &&
      chunk->stored_bytes == index.stored_bytes &&
      chunk->uncompressed_bytes == index.uncompressed_bytes;
  return agrees ? Status() : wrong(at_text(index) + " does not agree with the chunk there");
}

/// @param left  message indexes that may still be read
Status read_message_indexes(const ReadableFile& file, McapIndexedChunk& chunk, std::size_t& left) {
  const McapChunkIndex& index = chunk.index;
  const std::uint64_t end = index.offset + index.length + index.index_length;
  std::uint64_t at = index.offset + index.length;
  while (at < end) {
    // With the channel's number.
    std::array<std::uint8_t, kMcapRecordHeaderBytes + 2> bytes{};
    const bool fits = end - at >= bytes.size() && left > 0;
    if (fits) {
      if (Status status = file.read_at(at, bytes); !status) return status;
    }
    const McapRecord record = fits ? mcap_record_at(bytes) : McapRecord{};
    if (record.opcode != McapOpcode::kMessageIndex || record.length < 2 ||
        record.length > end - at - kMcapRecordHeaderBytes) {
      return wrong(at_text(index) + " has wrong message indexes");
    }
    --left;
    chunk.channels.push_back(static_cast<std::uint16_t>(
        bytes[kMcapRecordHeaderBytes] | unsigned{bytes[kMcapRecordHeaderBytes + 1]} << 8U));
    at += kMcapRecordHeaderBytes + record.length;
  }
  if (chunk.channels.empty() && index.last_ns != 0) {
    return wrong(at_text(index) + " has no message indexes");
  }
  return {};
}

}  // namespace

Result<McapSummary> read_mcap_summary(const ReadableFile& file) {
  const Result<SummaryBytes> bytes = read_summary_bytes(file);
  if (!bytes) return bytes.error();
  Result<McapSummary> summary = summary_in(*bytes);
  if (!summary) return summary.error();
  if (Status status = check_places(*summary); !status) return status.error();
  std::size_t left = kMaxMessageIndexes;
  for (McapIndexedChunk& chunk : summary->chunks) {
    Status status = check_chunk(file, chunk.index);
    if (status) status = read_message_indexes(file, chunk, left);
    if (!status) return status.error();
    summary->channels.insert(chunk.channels.begin(), chunk.channels.end());
  }
  return summary;
}

}  // namespace overfly::flight::logs
