// ROS 1 door of a build without ROS 1.
#include "vo_bridges/ros1/ros1_estimator.hpp"

namespace overfly {

Result<std::unique_ptr<VoPort>> create_ros1_estimator(const Ros1EstimatorOptions& /*options*/) {
  return Error{ErrorCode::kUnsupported,
               "this build has no ROS 1 support: install libroscpp-dev, libsensor-msgs-dev, "
               "libnav-msgs-dev, libtf2-msgs-dev and librosbag-storage-dev, and rebuild"};
}

}  // namespace overfly
