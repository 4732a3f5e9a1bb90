#include "server/logs/known_formats.hpp"

#include <utility>

#include "server/files/data_files.hpp"

namespace overfly::server {

KnownFormats::KnownFormats(std::function<std::string(const std::filesystem::path&)> detect)
    : detect_(std::move(detect)) {}

std::string KnownFormats::of(const std::filesystem::path& file, const FileStamp& stamp) {
  {
    const std::lock_guard lock(mutex_);
    const auto known = known_.find(file);
    if (known != known_.end() && known->second.stamp == stamp) return known->second.format;
  }
  std::string format = detect_(file);
  const std::lock_guard lock(mutex_);
  if (known_.size() >= kMaxVisitedFiles) known_.clear();
  known_[file] = {stamp, format};
  return format;
}

}  // namespace overfly::server
