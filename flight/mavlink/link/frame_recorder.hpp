// Records what a link receives as a telemetry log (.tlog).
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"

namespace overfly::flight::mavlink {

/// Appends every frame as it was received, after the time of reception: 8 bytes, microseconds since
/// 1970, big-endian. A program that is killed loses at most half a second.
class FrameRecorder {
 public:
  /// What a run's recording may take.
  static constexpr std::uint64_t kMostBytes = std::uint64_t{2} << 30U;

  /// @param file  must not exist
  /// @param most_bytes  frames beyond this size of the file are counted only
  /// Errors: kIo naming the file.
  static Result<std::shared_ptr<FrameRecorder>> create(const std::filesystem::path& file,
                                                       std::uint64_t most_bytes = kMostBytes);
  /// Writes what waits.
  ~FrameRecorder();
  FrameRecorder(const FrameRecorder&) = delete;
  FrameRecorder& operator=(const FrameRecorder&) = delete;

  /// May be called from any thread.
  void add(std::span<const std::uint8_t> frame, std::chrono::system_clock::time_point received);
  /// What was left out and why, in one sentence; empty if all is recorded.
  [[nodiscard]] std::string problem() const;

 private:
  FrameRecorder(std::filesystem::path file, FileDescriptor descriptor, std::uint64_t most_bytes)
      : file_(std::move(file)), descriptor_(std::move(descriptor)), most_bytes_(most_bytes) {}
  void flush();

  std::filesystem::path file_;
  FileDescriptor descriptor_;
  std::uint64_t most_bytes_;
  mutable std::mutex mutex_;
  std::vector<std::uint8_t> waiting_;
  std::chrono::steady_clock::time_point flushed_;
  std::uint64_t bytes_ = 0;
  std::uint64_t left_out_ = 0;
  std::string failure_;  ///< of writing; nothing is written after it
};

}  // namespace overfly::flight::mavlink
