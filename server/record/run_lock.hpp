#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace overfly::server {

/// Marks a run folder as in use while both the object and the process live: the operating system
/// releases the lock when the process is killed.
class RunLock {
 public:
  /// Waits 0.1 s for it at most. Errors: kConflict if another process holds it; kIo.
  static Result<RunLock> take(const std::filesystem::path& folder);
  /// True while a process (including this one) holds the lock.
  [[nodiscard]] static bool held(const std::filesystem::path& folder);
  /// The file of a run folder that is locked, by flock(2).
  [[nodiscard]] static std::filesystem::path file_of(const std::filesystem::path& folder);
  /// Keeps room on the disk in the lock's file, if there is any and the file system can: a run that
  /// fills the disk can then still write its end.
  void keep_room() const;
  void free_room() const;
  ~RunLock();  ///< releases and removes the file
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&& other) noexcept;

 private:
  RunLock(int descriptor, std::filesystem::path file);
  int descriptor_ = -1;
  std::filesystem::path file_;
};

}  // namespace overfly::server
