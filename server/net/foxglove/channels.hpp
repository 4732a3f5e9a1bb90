// The channels of a run for clients of the Foxglove protocol. Topics and frames are those of the
// run's export as MCAP file, where that has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "server/record/run_info.hpp"
#include "server/ros2/ros2_type.hpp"

namespace overfly::net::foxglove {

enum class ChannelKind {
  kTransforms,
  kLog,
  kTruthPath,
  kTruthFix,
  kCameraTruth,  ///< `index`: camera
  kCameraInfo,
  kCameraImage,
  kPose,  ///< in the estimator's own frame; `index`: estimator
  kWorldPose,
  kPath,
  kFix,
  kState,
  kPoints,
  kDebugImage,
};

struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  ChannelKind kind = ChannelKind::kLog;
  std::size_t index = 0;
  const server::Ros2Type* type = nullptr;  ///< not null
};

/// Names of a run's frames and topics.
struct FlightNames {
  struct Camera {
    std::string topics;  ///< "/camera"
    std::string frame;   ///< "camera_optical_frame"
    bool operator==(const Camera&) const = default;
  };
  struct Estimate {
    std::string topics;  ///< "/estimates/feature"
    std::string frame;   ///< of its camera where it estimates it to be: "feature_camera"
    std::string own;     ///< its own frame: "feature_vo"
    bool operator==(const Estimate&) const = default;
  };
  std::vector<Camera> cameras;
  std::vector<Estimate> estimates;
  bool operator==(const FlightNames&) const = default;
};

[[nodiscard]] FlightNames names_of(const std::vector<server::RunCamera>& cameras,
                                   const std::vector<std::string>& estimators);
/// @param first_id  of the first channel; the others follow
[[nodiscard]] std::vector<Channel> channels_of(const FlightNames& names, std::uint32_t first_id);

}  // namespace overfly::net::foxglove
