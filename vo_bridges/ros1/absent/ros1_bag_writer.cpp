// Bags where ROS 1 is not built in.
#include "vo_bridges/ros1/ros1_bag_writer.hpp"

namespace overfly {

Result<std::unique_ptr<Ros1BagWriter>> Ros1BagWriter::create(const std::filesystem::path& file) {
  return Error{ErrorCode::kUnsupported,
               file.string() +
                   ": this build writes no ROS bags: install librosbag-storage-dev, libroscpp-dev, "
                   "libsensor-msgs-dev, libnav-msgs-dev and libtf2-msgs-dev, and build again"};
}

}  // namespace overfly
