#include "server/scenario/estimator_spec.hpp"

namespace overfly::server {

bool is_outside_estimator(const std::string& type) {
  return type == "process" || type == "lcm" || type == "ros1";
}

bool is_baseline_estimator(const std::string& type) {
  return type == "baseline_hold" || type == "baseline_homography" ||
         type == "baseline_dead_reckoning";
}

bool is_test_estimator(const std::string& type) { return type == "perfect" || type == "drifting"; }

}  // namespace overfly::server
