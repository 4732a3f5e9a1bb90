// A private folder for temporary files.
#pragma once

#include <filesystem>
#include <utility>

#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"

namespace overfly::process {

/// Accessible by this user only, in the system's folder for temporary files; removed with its
/// content. It is locked while it is used: folders of programs that were killed are removed when
/// the next one is created.
class PrivateFolder {
 public:
  /// Errors: kIo.
  static Result<PrivateFolder> create();
  ~PrivateFolder();

  PrivateFolder(PrivateFolder&& other) noexcept;
  PrivateFolder& operator=(PrivateFolder&& other) noexcept;
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  PrivateFolder(std::filesystem::path path, FileDescriptor held)
      : path_(std::move(path)), held_(std::move(held)) {}

  std::filesystem::path path_;  // empty = moved away
  FileDescriptor held_;         // the folder, locked
};

}  // namespace overfly::process
