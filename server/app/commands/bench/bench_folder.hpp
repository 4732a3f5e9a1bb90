// A temporary folder for a measurement's output, removed by the destructor.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "core/result.hpp"

namespace overfly::app {

class BenchFolder {
 public:
  static Result<BenchFolder> create() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "overfly-bench-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      return Error{ErrorCode::kIo, pattern + ": cannot be made"};
    }
    return BenchFolder(pattern);
  }
  ~BenchFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  BenchFolder(BenchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  BenchFolder(const BenchFolder&) = delete;
  BenchFolder& operator=(const BenchFolder&) = delete;
  BenchFolder& operator=(BenchFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit BenchFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace overfly::app
