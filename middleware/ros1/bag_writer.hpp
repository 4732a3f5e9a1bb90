// Writes images, calibration, truth and samples of sensors to a ROS 1 bag (format 2.0).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"

namespace overfly::ros1 {

/// Writes messages in call order. Stamps are Unix times in [0, 2^32 s); each is also the message's
/// time in the bag, except that samples of sensors have the time at which they were available.
class BagWriter {
 public:
  /// Errors: kUnsupported if ROS 1 is not built in; kIo naming the file.
  [[nodiscard]] static Result<std::unique_ptr<BagWriter>> create(const std::filesystem::path& file);
  virtual ~BagWriter() = default;

  /// sensor_msgs/Image: mono8 or rgb8. Errors: kIo naming the file.
  [[nodiscard]] virtual Status add_image(const std::string& topic,
                                         const std::string& frame_id,
                                         std::int64_t stamp_ns,
                                         const Image& image) = 0;
  /// sensor_msgs/CameraInfo (lens models: message_from in messages.hpp).
  [[nodiscard]] virtual Status add_camera_info(const std::string& topic,
                                               const std::string& frame_id,
                                               std::int64_t stamp_ns,
                                               const CameraModel& camera) = 0;
  /// geometry_msgs/PoseStamped of a frame in `parent_frame`.
  [[nodiscard]] virtual Status add_pose(const std::string& topic,
                                        const std::string& parent_frame,
                                        std::int64_t stamp_ns,
                                        const Pose& T_parent_child) = 0;
  /// tf2_msgs/TFMessage with one transform, on /tf.
  [[nodiscard]] virtual Status add_transform(const std::string& parent_frame,
                                             const std::string& child_frame,
                                             std::int64_t stamp_ns,
                                             const Pose& T_parent_child) = 0;
  /// On the topics of sensor_messages.hpp.
  /// @param epoch_utc_ns  Unix time of t = 0
  [[nodiscard]] virtual Status add_samples(const SensorSamples& samples,
                                           std::int64_t epoch_utc_ns) = 0;
  /// Writes the index; nothing may be added afterwards. Errors: kIo naming the file.
  [[nodiscard]] virtual Status close() = 0;
};

}  // namespace overfly::ros1
