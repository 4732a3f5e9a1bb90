// What `overfly doctor` says about ROS 1.
#pragma once

#include <string>

namespace overfly {

struct Ros1Findings {
  bool built_in = false;
  bool works = false;   ///< nothing in the way of an estimator behind ROS topics
  std::string finding;  ///< one line: version, master, environment
  std::string remedy;   ///< empty when all is well
};

/// Looks at this build, the environment (ROS_MASTER_URI, ROS_IP, ROS_HOSTNAME) and the master
/// there, for at most a second. That no master runs is no fault: one is started with the estimator.
[[nodiscard]] Ros1Findings ros1_findings();

}  // namespace overfly
