// Options of a flight from ROS topics.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/time.hpp"

namespace overfly::flight::ros_live {

/// The topics of a vehicle and what they are taken for. The defaults are MAVROS's.
struct RosFlight {
  std::string master_uri = "http://127.0.0.1:11311";
  std::string node_name = "overfly";
  /// PoseStamped or Odometry.
  std::string pose_topic = "/mavros/local_position/pose";
  std::string global_topic = "/mavros/global_position/global";  ///< NavSatFix
  std::string imu_topic = "/mavros/imu/data";                   ///< Imu
  std::string state_topic =
      "/mavros/state";  ///< mavros_msgs/State, for modes and `stop_on_disarm`; may be empty
  /// Imu, MagneticField, FluidPressure, NavSatFix and Range: what the vehicle's sensors measure, in
  /// addition to the topics above.
  std::vector<std::string> sensor_topics = {"/mavros/imu/data_raw",
                                            "/mavros/imu/mag",
                                            "/mavros/imu/static_pressure",
                                            "/mavros/imu/diff_pressure",
                                            "/mavros/global_position/raw/fix",
                                            "/mavros/rangefinder/rangefinder"};
  bool local = false;  ///< positions are those of the pose topic, else of the global topic
  bool attitude_of_pose = false;  ///< attitudes are those of the pose topic, else of the imu topic
  /// Where local positions count from, in metres east, north and up; the world's origin if empty.
  std::optional<Geodetic> origin;
  std::int64_t gap_limit_ns = kNsPerS / 2;  ///< longer gaps between samples are reported
  /// A wait for a sample, and for the master, ends with an error after this time.
  std::chrono::milliseconds patience{10000};
  bool stop_on_disarm = true;  ///< the state topic says "disarmed" after it has said "armed"

  [[nodiscard]] const std::string& position_topic() const {
    return local ? pose_topic : global_topic;
  }
  [[nodiscard]] const std::string& attitude_topic() const {
    return attitude_of_pose ? pose_topic : imu_topic;
  }
};

}  // namespace overfly::flight::ros_live
