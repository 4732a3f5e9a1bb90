#include "server/scenario/estimator_spec.hpp"

namespace overfly::server {

bool is_outside_estimator(const std::string& type) {
  return type == "process" || type == "lcm" || type == "ros1";
}

bool is_test_estimator(const std::string& type) { return type == "perfect" || type == "drifting"; }

}  // namespace overfly::server
