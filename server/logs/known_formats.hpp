// Remembers the formats of files that do not change.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "server/files/file_stamp.hpp"

namespace overfly::server {

/// Looks into a file again only after it has changed. Thread-safe.
class KnownFormats {
 public:
  /// @param detect  reads the format of a file; empty: none that is served
  explicit KnownFormats(std::function<std::string(const std::filesystem::path&)> detect);

  /// @param stamp  of the file now
  [[nodiscard]] std::string of(const std::filesystem::path& file, const FileStamp& stamp);

 private:
  struct Known {
    FileStamp stamp;
    std::string format;
  };

  const std::function<std::string(const std::filesystem::path&)> detect_;
  std::mutex mutex_;
  std::map<std::filesystem::path, Known> known_;
};

}  // namespace overfly::server
