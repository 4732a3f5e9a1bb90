// Who receives the messages of a recording, and where they are in its file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "flight/logs/ros/chunk_reader.hpp"
#include "flight/logs/ros/ros_cursor.hpp"

namespace overfly::flight::logs {

/// The stored bytes of a chunk.
struct ChunkPlace {
  std::uint64_t file_offset = 0;
  std::uint64_t stored_bytes = 0;
  ChunkCompression compression = ChunkCompression::kNone;
  std::uint64_t declared_bytes = 0;  ///< size when decompressed
};

/// Where the data of a message are.
struct MessagePlace {
  std::optional<ChunkPlace> chunk;  ///< empty: the message is not in a chunk
  std::uint64_t offset = 0;         ///< in the decompressed chunk, or in the file
  std::uint64_t bytes = 0;
};

/// Receives the topics and messages of a recording in the order of the file.
class RosMessageSink {
 public:
  using Topic = std::size_t;

  virtual ~RosMessageSink() = default;

  /// The topic of this name, type and encoding: a new one, or one that was added before.
  /// @return empty if its messages are not wanted
  [[nodiscard]] virtual std::optional<Topic> add(const std::string& name,
                                                 std::string_view type,
                                                 RosEncoding encoding) = 0;
  /// @param data         serialised message, or of long ones at least the first kMessageBytes
  /// @param recorded_ns  time of recording
  virtual void take(Topic topic,
                    std::span<const std::uint8_t> data,
                    std::uint64_t recorded_ns,
                    const MessagePlace& place) = 0;
  /// Called at the end.
  virtual void report() = 0;

  /// The fields in front of an image, and the whole of other known messages, need less than this,
  /// if their frames have sensible names.
  static constexpr std::size_t kMessageBytes = std::size_t{1} << 16U;
};

}  // namespace overfly::flight::logs
