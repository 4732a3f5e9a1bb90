// A part of the ROS graph that one user of this process's node needs exclusively. Does not require
// ROS.
#pragma once

#include <string>

namespace overfly::ros1 {

struct OwnTopic {
  const char* option;  ///< option that names it
  std::string name;
  bool is_transform = false;  ///< "FRAME in FRAME on /tf": other transforms may share /tf
};

/// Removes the leading slash: "world" and "/world" name the same frame (tf2 uses no leading slash,
/// tf did), and the same topic without a ROS_NAMESPACE.
[[nodiscard]] inline std::string bare_name(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

}  // namespace overfly::ros1
