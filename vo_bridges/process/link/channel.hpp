// A connection that exchanges messages.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "core/camera/image.hpp"
#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"
#include "vo_bridges/process/link/wire.hpp"

namespace overfly::process {

using Clock = std::chrono::steady_clock;

/// Sends and receives in one loop, so that two programs with full buffers never block each other.
/// Data that is not sent at a deadline is sent by the next call. Not thread-safe.
class Channel {
 public:
  explicit Channel(FileDescriptor socket) : socket_(std::move(socket)) {}

  /// Queues bytes, the pixels of an image after them, and a descriptor to be sent with the first
  /// byte.
  void enqueue(std::string bytes,
               std::shared_ptr<const Image> pixels = nullptr,
               FileDescriptor attached = {});
  /// Sends queued data and returns the next message, or nothing at the deadline.
  /// Errors: kInternal if the other side has closed the connection, sent an invalid message, or
  /// sends too much.
  [[nodiscard]] Result<std::optional<Message>> next(Clock::time_point deadline);
  /// Restarts the per-frame limits for a frame of `pixels` pixels.
  void begin_frame(std::size_t pixels);
  /// Restarts the counts; the limits of the current frame stay.
  void begin_counts();
  /// Whether the other side has closed the connection.
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  struct Chunk {
    std::string bytes;
    std::shared_ptr<const Image> pixels;
    FileDescriptor attached;
  };

  [[nodiscard]] Status send_some();
  [[nodiscard]] Status receive_some();
  /// The first complete message in the received bytes.
  [[nodiscard]] Result<std::optional<Message>> take_message();
  [[nodiscard]] Result<MessageType> check_header(std::string_view header, std::size_t* length);

  FileDescriptor socket_;
  bool closed_ = false;
  std::deque<Chunk> out_;
  std::size_t sent_of_first_ = 0;
  std::string in_;
  std::size_t taken_ = 0;  // bytes consumed from in_
  std::size_t frame_pixels_ = 0;
  std::size_t frame_messages_ = 0;
  std::size_t frame_bytes_ = 0;
};

}  // namespace overfly::process
