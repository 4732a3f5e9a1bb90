// ROS bag writer of a build without ROS 1.
#include "middleware/ros1/bag_writer.hpp"

namespace overfly::ros1 {

Result<std::unique_ptr<BagWriter>> BagWriter::create(const std::filesystem::path& file) {
  return Error{
      ErrorCode::kUnsupported,
      file.string() +
          ": this build cannot write ROS bags: install librosbag-storage-dev, libroscpp-dev, "
          "libsensor-msgs-dev, libnav-msgs-dev and libtf2-msgs-dev, and rebuild"};
}

}  // namespace overfly::ros1
