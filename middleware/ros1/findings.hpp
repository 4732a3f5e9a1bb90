// ROS 1 support on this machine, for `overfly doctor`.
#pragma once

#include <string>

namespace overfly::ros1 {

/// True if this build supports ROS 1.
[[nodiscard]] bool is_built_in();

struct Findings {
  bool built_in = false;
  bool works = false;   ///< other nodes can be connected by topics
  std::string finding;  ///< one line: version, master, environment
  std::string remedy;   ///< empty if there is no problem
};

/// Checks this build, the environment (ROS_MASTER_URI, ROS_IP, ROS_HOSTNAME) and the master, within
/// a second. A master that does not run is not a problem: it may be started later.
[[nodiscard]] Findings findings();

}  // namespace overfly::ros1
