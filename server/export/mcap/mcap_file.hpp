// Writes MCAP files: chunks, their indexes, and a summary, so that players can seek.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server {

using McapBytes = std::vector<std::uint8_t>;

/// After the "MCAP File Format Specification" (major version 0). Chunks are not compressed; all
/// checksums are written. What was written when the program is killed is whole up to the last
/// chunk.
class McapFile {
 public:
  using ChannelId = std::uint16_t;

  /// @param profile  of the messages: "ros2"
  /// Errors: kIo naming the file; it must not exist.
  static Result<McapFile> create(const std::filesystem::path& file, std::string_view profile);

  /// Adds a channel and its schema. Schemas of the same name are written once.
  /// @param definition  of the type and all types in it, as ros2msg
  /// @pre at most 65535 channels
  [[nodiscard]] ChannelId add_channel(const std::string& topic,
                                      const std::string& type,
                                      std::string_view definition);
  /// @param data  serialised as plain CDR
  /// Errors: kIo naming the file.
  Status add_message(ChannelId channel,
                     std::uint64_t log_time_ns,
                     std::span<const std::uint8_t> data);
  /// Writes the summary; nothing may be added afterwards. Errors: kIo naming the file.
  Status close();

 private:
  /// What the summary says of a chunk.
  struct ChunkEntry {
    std::uint64_t first_ns = 0;
    std::uint64_t last_ns = 0;
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;  ///< of the record
    std::map<ChannelId, std::uint64_t> index_offsets;
    std::uint64_t index_bytes = 0;
    std::uint64_t record_bytes = 0;  ///< of the records in it
  };

  explicit McapFile(AppendFile file) : file_(std::move(file)) {}
  Status write(const McapBytes& bytes);
  Status end_chunk();
  [[nodiscard]] McapBytes summary() const;

  AppendFile file_;
  std::uint64_t at_ = 0;                          ///< bytes written so far
  std::uint32_t crc_ = 0;                         ///< of these bytes
  McapBytes records_;                             ///< of the present chunk
  ChunkEntry chunk_;                              ///< the present one
  std::map<ChannelId, McapBytes> message_index_;  ///< of the present chunk
  std::map<std::string, std::uint16_t> schemas_;
  McapBytes schema_records_;
  McapBytes channel_records_;
  std::vector<ChunkEntry> chunks_;
  std::map<ChannelId, std::uint64_t> message_counts_;
};

}  // namespace overfly::server
