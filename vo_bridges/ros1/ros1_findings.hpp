// ROS 1 support on this machine, for `overfly doctor`.
#pragma once

#include <string>

namespace overfly {

struct Ros1Findings {
  bool built_in = false;
  bool works = false;   ///< estimators can be connected by ROS topics
  std::string finding;  ///< one line: version, master, environment
  std::string remedy;   ///< empty if there is no problem
};

/// Checks this build, the environment (ROS_MASTER_URI, ROS_IP, ROS_HOSTNAME) and the master, within
/// a second. A master that does not run is not a problem: it is started with the estimator.
[[nodiscard]] Ros1Findings ros1_findings();

}  // namespace overfly
