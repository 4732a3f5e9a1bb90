// The door where ROS 1 is not built in.
#include "vo_bridges/ros1/ros1_estimator.hpp"

namespace overfly {

bool ros1_is_built_in() { return false; }

Result<std::unique_ptr<VoPort>> create_ros1_estimator(const Ros1EstimatorOptions& /*options*/) {
  return Error{ErrorCode::kUnsupported,
               "this build does not speak ROS 1: install libroscpp-dev, libsensor-msgs-dev, "
               "libnav-msgs-dev, libtf2-msgs-dev and librosbag-storage-dev, and build again"};
}

}  // namespace overfly
