// ROS's messages in C++20. Their headers ask std::allocator<void> for `rebind`, which that standard
// took away; the messages are templates, and take an allocator of ours that has it.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Transform.h>
#include <nav_msgs/Odometry.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Empty.h>
#include <tf2_msgs/TFMessage.h>

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace overfly::ros1 {

/// Of one array of a message: an image of 8192 x 8192 pixels with four channels. ROS makes room for
/// as many elements as a message announces before it looks whether they are there.
inline constexpr std::size_t kMaxArrayBytes = std::size_t{8192} * 8192 * 4;

// NOLINTBEGIN(readability-identifier-naming): these are the standard's names

/// std::allocator with what ROS's serialisation asks of it, and the limit kMaxArrayBytes:
/// std::bad_alloc above it, which roscpp takes for a message that cannot be read.
template <typename T>
struct VectorAllocator : std::allocator<T> {
  VectorAllocator() = default;
  template <typename Other>
  VectorAllocator(const VectorAllocator<Other>& /*other*/) {}
  [[nodiscard]] T* allocate(std::size_t count) {
    if (count > kMaxArrayBytes / sizeof(T)) throw std::bad_alloc();
    return std::allocator<T>::allocate(count);
  }
  template <typename Other>
  struct rebind {
    using other = VectorAllocator<Other>;
  };
};

/// Strings stay std::string.
struct MessageAllocator {
  using value_type = char;
  template <typename T>
  struct rebind {
    using other =
        std::conditional_t<std::is_same_v<T, char>, std::allocator<char>, VectorAllocator<T>>;
  };
};

// NOLINTEND(readability-identifier-naming)

using CameraInfoMessage = sensor_msgs::CameraInfo_<MessageAllocator>;
using ClockMessage = rosgraph_msgs::Clock_<MessageAllocator>;
using EmptyMessage = std_msgs::Empty_<MessageAllocator>;
using ImageMessage = sensor_msgs::Image_<MessageAllocator>;
using OdometryMessage = nav_msgs::Odometry_<MessageAllocator>;
using PoseMessage = geometry_msgs::Pose_<MessageAllocator>;
using PoseStampedMessage = geometry_msgs::PoseStamped_<MessageAllocator>;
using PoseWithCovarianceStampedMessage =
    geometry_msgs::PoseWithCovarianceStamped_<MessageAllocator>;
using TransformMessage = geometry_msgs::Transform_<MessageAllocator>;
using TransformsMessage = tf2_msgs::TFMessage_<MessageAllocator>;
using TransformStampedMessage = geometry_msgs::TransformStamped_<MessageAllocator>;

}  // namespace overfly::ros1
