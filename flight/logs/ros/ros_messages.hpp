// The ROS messages that describe a flight, ROS 1 and ROS 2.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/sensors/sensor_samples.hpp"
#include "flight/logs/log_sink.hpp"
#include "flight/logs/ros/ros_cursor.hpp"

namespace overfly::flight::logs {

enum class RosType {
  kPoseStamped,      ///< geometry_msgs/PoseStamped
  kOdometry,         ///< nav_msgs/Odometry
  kNavSatFix,        ///< sensor_msgs/NavSatFix
  kImu,              ///< sensor_msgs/Imu
  kMagneticField,    ///< sensor_msgs/MagneticField
  kFluidPressure,    ///< sensor_msgs/FluidPressure
  kRange,            ///< sensor_msgs/Range
  kImage,            ///< sensor_msgs/Image
  kCompressedImage,  ///< sensor_msgs/CompressedImage
  kOther,
};

/// The type of a name: "geometry_msgs/PoseStamped" (ROS 1), "geometry_msgs/msg/PoseStamped" (ROS
/// 2).
[[nodiscard]] RosType ros_type_named(std::string_view name);

/// How the topic of a type contributes to a flight; the name is that of the topic.
///
/// A topic with "truth" in its name is a simulator's or a tracking system's state, NavSatFix is
/// GPS, all others are estimates. Types with measurements give samples of sensors, but not on a
/// topic with "truth" in its name.
[[nodiscard]] StreamDescription describe_topic(std::string_view topic, RosType type);

/// What a message says of the flight.
struct RosSample {
  std::int64_t stamp_ns = 0;  ///< header.stamp
  /// North, east, down [m]; or of NavSatFix latitude, longitude [deg], height above the ellipsoid
  /// [m].
  std::optional<Eigen::Vector3d> position;
  std::optional<Eigen::Quaterniond> R_ned_body;  ///< not normalised
  /// The frame of the camera whose pose it is: its axes were read as those of a body
  /// forward-left-up. Empty: the pose of a body.
  std::string camera_frame;
  bool invalid = false;  ///< the sender marks the sample as invalid: no fix
  SensorSamples sensors;
};

/// How a topic's name tells what its messages are.
struct RosTopicName {
  bool is_truth = false;         ///< "truth": a simulator's or a tracking system's state
  bool is_raw = false;           ///< "raw": measured, where others are estimated
  bool is_differential = false;  ///< "diff_press", "differential_press": of a Pitot tube
};
[[nodiscard]] RosTopicName ros_topic_name(std::string_view topic);

/// Reads the header, and the position and attitude of types that have them.
///
/// Frames are those of REP-103: a world east-north-up, a body forward-left-up. A frame_id whose
/// last word is "ned" ("odom_ned") is a world north-east-down, a frame of the body whose last word
/// is "frd" is forward-right-down; the body's frame is child_frame_id of Odometry and frame_id of
/// Imu. An Odometry whose child_frame_id is an optical frame has the pose of that camera
/// (camera_frame). An Imu without orientation (orientation_covariance[0] = -1) gives neither.
/// Samples of sensors are those of ros_sensors.hpp.
/// @return empty if the message ends early, or the type is kOther
[[nodiscard]] std::optional<RosSample> decode_ros(RosType type,
                                                  RosCursor message,
                                                  const RosTopicName& topic = {});

/// The cursor behind the header that states the byte order of CDR.
/// @return empty for other representations than plain CDR, and for kOther
[[nodiscard]] std::optional<RosCursor> ros_cursor_of(std::span<const std::uint8_t> data,
                                                     RosEncoding encoding);

struct RosHeader {
  std::int64_t stamp_ns = 0;
  std::string_view frame_id;
};
/// Moves behind the header.
[[nodiscard]] RosHeader take_header(RosCursor& message);

}  // namespace overfly::flight::logs
