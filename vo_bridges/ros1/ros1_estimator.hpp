// An estimator that is a ROS 1 node: images go out on topics, poses come back on others
// (vo_bridges/ros1/README.md).
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "vo_bridges/parameter.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// What the estimator publishes its pose as.
enum class Ros1PoseType { kPoseStamped, kPoseWithCovarianceStamped, kOdometry, kTf };

/// No two estimators of a process share a topic, nor a transform on /tf.
struct Ros1EstimatorOptions {
  std::string master_uri = "http://127.0.0.1:11311";
  std::string node_name = "overfly";  ///< of this process: the first estimator's counts
  std::string image_topic = "/camera/image_raw";
  std::string camera_info_topic = "/camera/camera_info";
  std::string pose_topic = "/vo/pose";  ///< not used with kTf
  Ros1PoseType pose_type = Ros1PoseType::kPoseStamped;
  std::string debug_image_topic;        ///< empty = none
  std::string reset_topic;              ///< std_msgs/Empty at every reset; empty = none
  std::string camera_frame = "camera";  ///< frame_id of images; with kTf the pose's child
  std::string vo_frame = "world";       ///< with kTf the pose's parent
  /// True where the pose says camera from VO frame (T_camera_vo), as ORB-SLAM2's Tcw.
  bool pose_is_camera_from_world = false;
  /// True where the pose's camera has ROS's body axes (REP 103: x along the view, y left, z up)
  /// instead of optical ones.
  bool pose_in_body_axes = false;
  bool publish_clock = true;  ///< /clock, for nodes under use_sim_time
  /// The estimate on /tf, as camera_frame in vo_frame, for those that look on. Not with kTf.
  bool publish_tf = false;
  int queue_size = 8;  ///< of each topic, in [1, 1000]
  /// True: wait for the pose of each frame once it has published a first one. False: by the clock.
  bool lockstep = true;
  /// For the master and for a subscriber of images or calibration; again at the first frame, for
  /// the estimator to load and to advertise its pose.
  double start_timeout_s = 30.0;
  double answer_timeout_s = 2.0;
  /// Set on the parameter server under `parameter_namespace` before the estimator is waited for.
  VoParameters parameters;
  std::string
      parameter_namespace;  ///< whose parameters are read back into the result; empty = none
  /// When it turns true, every wait ends with kCancelled: within 50 ms, that for an answer after a
  /// second. Null = nobody cancels.
  const std::atomic<bool>* cancel = nullptr;
};

/// True where this build speaks ROS 1.
[[nodiscard]] bool ros1_is_built_in();

/// Waits for the master, then for a subscriber of the images or the calibration.
/// Errors: kUnsupported where ROS 1 is not built in; kInvalidArgument naming the option; kNotFound
/// when no master answers, or nobody subscribes to the images, in time; kConflict when this process
/// is the node of another master already, or another of its estimators has a topic; kCancelled.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_ros1_estimator(
    const Ros1EstimatorOptions& options);

}  // namespace overfly
