// Images and poses of ROS nodes, as roscpp takes them off the wire.
//
// The first byte chooses: an image, a pose.
#include <ros/serialization.h>

#include <vector>

#include "middleware/ros1/messages.hpp"
#include "tests/fuzz/input_folder.hpp"

namespace {

template <typename Message>
bool deserialise(const std::uint8_t* data, std::size_t size, Message* message) {
  std::vector<std::uint8_t> bytes(data, data + size);
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  try {
    ros::serialization::deserialize(stream, *message);
  } catch (const std::exception&) {
    return false;
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly::ros1;
  if (size < 2) return 0;  // roscpp hands no empty message over.
  if (data[0] == 'i') {
    ImageMessage image;
    if (deserialise(data + 1, size - 1, &image)) (void)rgb_image_from(image, 64, 48);
  } else {
    PoseMessage pose;
    if (deserialise(data + 1, size - 1, &pose)) (void)pose_from(pose);
  }
  return 0;
}
