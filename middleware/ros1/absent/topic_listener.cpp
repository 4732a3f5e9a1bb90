// Topics in a build without ROS 1.
#include "middleware/ros1/topic_listener.hpp"

namespace overfly::ros1 {

Result<std::unique_ptr<TopicListener>> TopicListener::open(const TopicListenerOptions& options,
                                                           Take /*take*/,
                                                           const std::atomic<bool>* /*cancel*/) {
  return Error{ErrorCode::kUnsupported,
               options.master_uri +
                   ": this build cannot listen to ROS topics: install libroscpp-dev, "
                   "libsensor-msgs-dev, libnav-msgs-dev, libtf2-msgs-dev and "
                   "librosbag-storage-dev, and rebuild"};
}

}  // namespace overfly::ros1
