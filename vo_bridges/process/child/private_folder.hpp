// A private folder for temporary files.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace overfly::process {

/// Accessible by this user only, in the system's folder for temporary files; removed with its
/// content.
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
  explicit PrivateFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;  // empty = moved away
};

}  // namespace overfly::process
