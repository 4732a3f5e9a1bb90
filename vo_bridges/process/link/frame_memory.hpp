// Shared memory that passes images to a local estimator without a socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/camera/image.hpp"
#include "core/outside/file_descriptor.hpp"

namespace overfly::process {

/// A memory file with slots used in turn. Only this process can write to it, and no process can
/// truncate it.
class FrameMemory {
 public:
  static constexpr std::size_t kSlots = 2;

  /// Empty if this machine does not support it; frames are then sent through the socket.
  static std::optional<FrameMemory> create(std::size_t slot_bytes);

  FrameMemory(FrameMemory&& other) noexcept;
  FrameMemory& operator=(FrameMemory&& other) noexcept;
  ~FrameMemory();

  [[nodiscard]] std::size_t slot_bytes() const { return slot_bytes_; }
  /// A duplicate descriptor of the file, to be passed on.
  [[nodiscard]] FileDescriptor descriptor() const;
  /// Copies the image into the least recently used slot and returns the slot's number.
  /// @pre the image has at most slot_bytes()
  [[nodiscard]] std::uint32_t store(const Image& image);

 private:
  FrameMemory() = default;

  FileDescriptor file_;
  std::uint8_t* bytes_ = nullptr;
  std::size_t slot_bytes_ = 0;
  std::uint32_t next_slot_ = 0;
};

}  // namespace overfly::process
