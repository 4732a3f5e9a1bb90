// Options of the ROS 1 door.
#pragma once

#include <atomic>
#include <string>

#include "vo_bridges/parameter.hpp"

namespace overfly {

/// Message type of the estimator's poses.
enum class Ros1PoseType { kPoseStamped, kPoseWithCovarianceStamped, kOdometry, kTf };

/// Two estimators of a process cannot share a topic or a transform on /tf.
struct Ros1EstimatorOptions {
  std::string master_uri = "http://127.0.0.1:11311";
  std::string node_name = "overfly";  ///< of this process: set by the first estimator
  std::string image_topic = "/camera/image_raw";
  std::string camera_info_topic = "/camera/camera_info";
  std::string pose_topic = "/vo/pose";  ///< not used with kTf
  Ros1PoseType pose_type = Ros1PoseType::kPoseStamped;
  std::string debug_image_topic;        ///< empty = none
  std::string camera_frame = "camera";  ///< frame_id of images; with kTf the pose's child
  std::string vo_frame = "world";       ///< with kTf the pose's parent
  /// True if the pose maps the VO frame to the camera (T_camera_vo), like ORB-SLAM2's Tcw.
  bool pose_is_camera_from_world = false;
  /// True if the pose's camera has ROS body axes (REP 103: x forward, y left, z up) instead of
  /// optical axes.
  bool pose_in_body_axes = false;
  /// Publishes the samples of the aircraft's sensors; set by the run if there are any.
  bool publish_sensors = false;
  std::string sensor_namespace = "/sensors";  ///< of their topics
  bool publish_clock = true;                  ///< /clock, for nodes under use_sim_time
  /// Publishes the estimate on /tf, as camera_frame in vo_frame, for observers. Not with kTf.
  bool publish_tf = false;
  int queue_size = 8;  ///< of each topic, in [1, 1000]
  /// True: after the first pose, wait for the pose of each frame. False: frames follow the clock.
  bool lockstep = true;
  /// Time limit for the master and for a subscriber of images or calibration; and again at the
  /// first frame, until the estimator has loaded and advertised its pose.
  double start_timeout_s = 30.0;
  double answer_timeout_s = 2.0;
  /// Set on the parameter server under `parameter_namespace` before the estimator is waited for.
  VoParameters parameters;
  std::string
      parameter_namespace;  ///< whose parameters are read back into the result; empty = none
  /// Set to true to cancel: every wait ends with kCancelled within 50 ms, the wait for an answer
  /// within a second. Null = not cancellable.
  const std::atomic<bool>* cancel = nullptr;
};

}  // namespace overfly
