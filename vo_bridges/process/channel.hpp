// One connection that speaks in messages.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "core/image.hpp"
#include "core/result.hpp"
#include "vo_bridges/process/file_descriptor.hpp"
#include "vo_bridges/process/wire.hpp"

namespace overfly::process {

using Clock = std::chrono::steady_clock;

/// Sends and receives in one loop, so that two programs with full buffers never wait for each
/// other; what is not sent at a deadline goes on with the next call. One thread at a time.
class Channel {
 public:
  explicit Channel(FileDescriptor socket) : socket_(std::move(socket)) {}

  /// Queues bytes, the image's after them, and a descriptor to go along with the first byte.
  void enqueue(std::string bytes,
               std::shared_ptr<const Image> pixels = nullptr,
               FileDescriptor attached = {});
  /// Sends what is queued; returns the next message, or nothing at the deadline.
  /// Errors: kInternal when the other side has closed, sent what is no message, or floods.
  [[nodiscard]] Result<std::optional<Message>> next(Clock::time_point deadline);
  /// From here on the limits of one frame count anew, for a frame of so many pixels.
  void begin_frame(std::size_t pixels);
  /// The limits count anew; what the frame under way may still bring stays as it was.
  void begin_counts();
  /// Whether the other side has closed.
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  struct Chunk {
    std::string bytes;
    std::shared_ptr<const Image> pixels;
    FileDescriptor attached;
  };

  [[nodiscard]] Status send_some();
  [[nodiscard]] Status receive_some();
  /// The first whole message of what has come.
  [[nodiscard]] Result<std::optional<Message>> take_message();
  [[nodiscard]] Result<MessageType> check_header(std::string_view header, std::size_t* length);

  FileDescriptor socket_;
  bool closed_ = false;
  std::deque<Chunk> out_;
  std::size_t sent_of_first_ = 0;
  std::string in_;
  std::size_t taken_ = 0;  // of in_
  std::size_t frame_pixels_ = 0;
  std::size_t frame_messages_ = 0;
  std::size_t frame_bytes_ = 0;
};

}  // namespace overfly::process
