// Samples of an aircraft's sensors as messages of ROS 2.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "server/ros2/ros2_type.hpp"

namespace overfly::server {

/// One message of a sample.
struct Ros2SampleMessage {
  std::string topic;
  const Ros2Type* type = nullptr;
  std::int64_t available_ns = 0;  ///< Unix time at which the sample was available
  std::vector<std::uint8_t> data;
};

/// Calls `take` for each message of the samples; stops at the first error. Topics, axes and units
/// are those of bags (middleware/ros1/sensor_messages.hpp), and so are the frames
/// (frame_names.hpp); unknown orientations and covariances are marked as the types say.
/// @param epoch_utc_ns  Unix time of t = 0
[[nodiscard]] Status with_each_ros2_sample(
    const SensorSamples& samples,
    std::int64_t epoch_utc_ns,
    const std::function<Status(const Ros2SampleMessage&)>& take);

}  // namespace overfly::server
