#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace overfly::engine {

/// Says that a process is at work in a run folder, for as long as the object and the process
/// live: the system itself takes the mark away when the process is killed.
class RunLock {
 public:
  /// Errors: kConflict while another holds it; kIo.
  static Result<RunLock> take(const std::filesystem::path& folder);
  /// True while some process (this one too) holds the lock.
  [[nodiscard]] static bool held(const std::filesystem::path& folder);
  ~RunLock();  ///< releases and removes the file
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&& other) noexcept;

 private:
  RunLock(int descriptor, std::filesystem::path file);
  int descriptor_ = -1;
  std::filesystem::path file_;
};

}  // namespace overfly::engine
