// ROS messages in C++20. Their headers need the `rebind` of std::allocator<void>, which C++20
// removed. The messages are templates and are instantiated with an allocator that provides it.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/TwistStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/serialization.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/NavSatFix.h>
#include <sensor_msgs/Range.h>
#include <sensor_msgs/Temperature.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

namespace overfly::ros1 {

// NOLINTBEGIN(readability-identifier-naming): names required by the standard

/// std::allocator with the members that ROS serialisation needs.
template <typename T>
struct VectorAllocator : std::allocator<T> {
  VectorAllocator() = default;
  template <typename Other>
  VectorAllocator(const VectorAllocator<Other>& /*other*/) {}
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

/// Reads an array of a message. ROS serialisation selects this overload by the allocator. The
/// default implementation allocates the announced number of elements before checking that they
/// exist.
/// @throws ros::serialization::StreamOverrunException before any allocation if they do not
template <typename T>
void deserialize(ros::serialization::IStream& stream, std::vector<T, VectorAllocator<T>>& array) {
  ros::serialization::IStream ahead = stream;
  std::uint32_t count = 0;
  ahead.next(count);
  const std::uint64_t least_bytes = ros::serialization::serializationLength(T{});
  if (count * least_bytes > ahead.getLength()) ros::serialization::throwStreamOverrun();
  ros::serialization::VectorSerializer<T, VectorAllocator<T>>::read(stream, array);
}

using CameraInfoMessage = sensor_msgs::CameraInfo_<MessageAllocator>;
using ClockMessage = rosgraph_msgs::Clock_<MessageAllocator>;
using FluidPressureMessage = sensor_msgs::FluidPressure_<MessageAllocator>;
using ImageMessage = sensor_msgs::Image_<MessageAllocator>;
using ImuMessage = sensor_msgs::Imu_<MessageAllocator>;
using MagneticFieldMessage = sensor_msgs::MagneticField_<MessageAllocator>;
using NavSatFixMessage = sensor_msgs::NavSatFix_<MessageAllocator>;
using OdometryMessage = nav_msgs::Odometry_<MessageAllocator>;
using PoseMessage = geometry_msgs::Pose_<MessageAllocator>;
using PoseStampedMessage = geometry_msgs::PoseStamped_<MessageAllocator>;
using PoseWithCovarianceStampedMessage =
    geometry_msgs::PoseWithCovarianceStamped_<MessageAllocator>;
using RangeMessage = sensor_msgs::Range_<MessageAllocator>;
using TemperatureMessage = sensor_msgs::Temperature_<MessageAllocator>;
using TransformMessage = geometry_msgs::Transform_<MessageAllocator>;
using TransformsMessage = tf2_msgs::TFMessage_<MessageAllocator>;
using TransformStampedMessage = geometry_msgs::TransformStamped_<MessageAllocator>;
using TwistStampedMessage = geometry_msgs::TwistStamped_<MessageAllocator>;

}  // namespace overfly::ros1
