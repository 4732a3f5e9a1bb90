// Flights on ROS topics in a build without ROS 1.
#include "middleware/ros1/flight_publisher.hpp"

namespace overfly::ros1 {

Result<std::unique_ptr<FlightPublisher>> FlightPublisher::open(
    const FlightPublisherOptions& options, const std::atomic<bool>* /*cancel*/) {
  return Error{ErrorCode::kUnsupported,
               options.master_uri +
                   ": this build cannot publish ROS topics: install libroscpp-dev, "
                   "libsensor-msgs-dev, libnav-msgs-dev, libtf2-msgs-dev and "
                   "librosbag-storage-dev, and rebuild"};
}

}  // namespace overfly::ros1
