// Topics and frames of exports with ROS messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/motion/pose.hpp"
#include "middleware/ros1/frame_names.hpp"
#include "server/export/dataset_writer.hpp"
#include "server/ros2/flight_names.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::server {

/// Topic and frame names of one camera.
struct RosCameraTopics {
  std::string image, info, truth;
  std::string frame;
};
[[nodiscard]] std::vector<RosCameraTopics> ros_camera_topics(
    const std::vector<CameraSpec>& cameras);

/// A pose of an estimator for a topic.
struct RosEstimate {
  std::string topic;     ///< /estimates/NAME/pose, /estimates/NAME/pose_world
  std::string frame_id;  ///< NAME_vo, or world
  std::int64_t t_ns = 0;
  Pose pose;
};

/// The estimates of a run, taken frame by frame.
class RosEstimates {
 public:
  /// @param estimates  must outlive the object
  explicit RosEstimates(const std::vector<PlannedEstimate>& estimates);

  /// All topics that may occur.
  [[nodiscard]] std::vector<std::string> topics() const;
  /// The poses of the estimators that tracked a frame: in their own frames, and in the world where
  /// they are aligned. Frames must increase from call to call.
  [[nodiscard]] std::vector<RosEstimate> of(std::int64_t frame);

 private:
  const std::vector<PlannedEstimate>& estimates_;
  std::vector<std::string> names_;  ///< as parts of topics
  std::vector<std::size_t> next_;   ///< sample, by estimator
};

}  // namespace overfly::server
