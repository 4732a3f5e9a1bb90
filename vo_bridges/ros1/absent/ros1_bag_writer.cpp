// ROS bag writer of a build without ROS 1.
#include "vo_bridges/ros1/ros1_bag_writer.hpp"

namespace overfly {

Result<std::unique_ptr<Ros1BagWriter>> Ros1BagWriter::create(const std::filesystem::path& file) {
  return Error{
      ErrorCode::kUnsupported,
      file.string() +
          ": this build cannot write ROS bags: install librosbag-storage-dev, libroscpp-dev, "
          "libsensor-msgs-dev, libnav-msgs-dev and libtf2-msgs-dev, and rebuild"};
}

}  // namespace overfly
