// Publishes a recorded flight on the topics of MAVROS. Does not require ROS.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"

namespace overfly::ros1 {

struct FlightPublisherOptions {
  std::string master_uri = "http://127.0.0.1:11311";
  std::string node_name = "overfly_play";
  std::chrono::milliseconds patience{10000};  ///< for the master's answer
};

/// The aircraft at one instant, with a Unix time as stamp.
struct PublishedInstant {
  std::int64_t stamp_ns = 0;  ///< in (0, 2^32 s)
  Eigen::Vector3d position_map_m =
      Eigen::Vector3d::Zero();  ///< east, north, up of the local origin
  /// enu: of the horizon where the aircraft is; body: forward-right-down.
  Eigen::Quaterniond R_enu_body = Eigen::Quaterniond::Identity();
  ImuSample imu;
  GpsSample gps;
};

/// The topics have MAVROS's names and types: /mavros/local_position/pose (PoseStamped),
/// /mavros/global_position/global (NavSatFix), /mavros/imu/data (Imu), /mavros/state
/// (mavros_msgs/State). World axes are east-north-up, body axes forward-left-up (REP-103).
class FlightPublisher {
 public:
  /// Messages of a topic that wait for a slow listener; the oldest are dropped.
  static constexpr std::uint32_t kMostWaiting = 20'000;

  /// @param cancel  ends the wait for the master; may be null
  /// Errors: kUnsupported if ROS 1 is not built in; kInvalidArgument naming the address; as
  /// Node::join.
  [[nodiscard]] static Result<std::unique_ptr<FlightPublisher>> open(
      const FlightPublisherOptions& options, const std::atomic<bool>* cancel);
  virtual ~FlightPublisher() = default;

  /// Publishes pose, position and IMU.
  virtual void publish(const PublishedInstant& instant) = 0;
  /// Publishes that the vehicle is connected and flies in AUTO, or that it is disarmed.
  virtual void publish_state(std::int64_t stamp_ns, bool armed) = 0;
  /// Somebody listens to one of the topics.
  [[nodiscard]] virtual bool is_heard() const = 0;
};

}  // namespace overfly::ros1
