// A type of ROS 2 messages, and what they begin with.
#pragma once

#include <cstdint>
#include <string>

namespace overfly::server {

struct Ros2Type {
  std::string name;        ///< "sensor_msgs/msg/Image"
  std::string definition;  ///< as ros2msg, with the types in it
};

struct Ros2Time {
  std::int64_t stamp_ns = 0;  ///< Unix time in [0, 2^31 s)
};

struct Ros2Header {
  std::int64_t stamp_ns = 0;  ///< Unix time in [0, 2^31 s)
  std::string frame_id;
};

}  // namespace overfly::server
