#include "vo_bridges/process/link/frame_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace overfly::process {

std::optional<FrameMemory> FrameMemory::create(std::size_t slot_bytes) {
  FrameMemory memory;
  memory.slot_bytes_ = slot_bytes;
  const std::size_t bytes = kSlots * slot_bytes;
  memory.file_ = FileDescriptor(::memfd_create("overfly-frames", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!memory.file_.open() || ::ftruncate(memory.file_.get(), static_cast<off_t>(bytes)) != 0) {
    return std::nullopt;
  }
  void* const mapped =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory.file_.get(), 0);
  if (mapped == MAP_FAILED) return std::nullopt;
  memory.bytes_ = static_cast<std::uint8_t*>(mapped);
  // Without the first two seals an estimator could truncate the file, and the next write here would
  // be fatal. Kernels before 5.1 lack the third seal, which makes all other mappings read-only.
  if (::fcntl(memory.file_.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) != 0) {
    return std::nullopt;
  }
  ::fcntl(memory.file_.get(), F_ADD_SEALS, F_SEAL_FUTURE_WRITE);
  ::fcntl(memory.file_.get(), F_ADD_SEALS, F_SEAL_SEAL);
  return memory;
}

FrameMemory::FrameMemory(FrameMemory&& other) noexcept
    : file_(std::move(other.file_)),
      bytes_(std::exchange(other.bytes_, nullptr)),
      slot_bytes_(other.slot_bytes_),
      next_slot_(other.next_slot_) {}

FrameMemory& FrameMemory::operator=(FrameMemory&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(bytes_, other.bytes_);
  std::swap(slot_bytes_, other.slot_bytes_);
  std::swap(next_slot_, other.next_slot_);
  return *this;
}

FrameMemory::~FrameMemory() {
  if (bytes_ != nullptr) ::munmap(bytes_, kSlots * slot_bytes_);
}

FileDescriptor FrameMemory::descriptor() const {
  return FileDescriptor(::fcntl(file_.get(), F_DUPFD_CLOEXEC, 0));
}

std::uint32_t FrameMemory::store(const Image& image) {
  const std::uint32_t slot = next_slot_;
  next_slot_ = (next_slot_ + 1) % kSlots;
  std::copy(image.data.begin(), image.data.end(), bytes_ + slot * slot_bytes_);
  return slot;
}

}  // namespace overfly::process
