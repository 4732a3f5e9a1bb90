// The settings file that ORB-SLAM2's constructor reads. C++11.
#pragma once

#include <string>

#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {

/// A temporary file, removed on destruction.
class SettingsFile {
 public:
  /// Throws std::runtime_error for a distortion that ORB-SLAM2 does not support, or if the file
  /// cannot be written.
  explicit SettingsFile(const Session& session);
  ~SettingsFile();
  SettingsFile(const SettingsFile&) = delete;
  SettingsFile& operator=(const SettingsFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace overfly_adapters
