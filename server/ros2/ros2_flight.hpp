// Messages of ROS 2 about a flight for viewers: compressed images, paths, points, places, logs, and
// the state of estimates.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/motion/pose.hpp"
#include "server/ros2/ros2_type.hpp"

namespace overfly::server {

extern const Ros2Type kRos2CompressedImage;
extern const Ros2Type kRos2Path;
extern const Ros2Type kRos2PointCloud;
extern const Ros2Type kRos2NavSatFix;
extern const Ros2Type kRos2Log;
/// Overfly's own: state, latency and errors of one answer.
extern const Ros2Type kRos2EstimateState;

/// A JPEG's message up to its bytes, which follow.
[[nodiscard]] std::vector<std::uint8_t> ros2_jpeg_head(const Ros2Header& header,
                                                       std::size_t jpeg_bytes);

struct StampedPose {
  std::int64_t stamp_ns = 0;  ///< Unix time
  Pose pose;
};
[[nodiscard]] std::vector<std::uint8_t> ros2_path(const Ros2Header& header,
                                                  const std::vector<StampedPose>& poses);
/// Coordinates as float32 x, y, z.
[[nodiscard]] std::vector<std::uint8_t> ros2_points(const Ros2Header& header,
                                                    const std::vector<Eigen::Vector3f>& points);
/// A place without a covariance. `altitude` is above the ellipsoid.
[[nodiscard]] std::vector<std::uint8_t> ros2_fix(const Ros2Header& header, const Geodetic& place);

struct Ros2LogLine {
  std::int64_t stamp_ns = 0;  ///< Unix time
  std::string level;          ///< "info", "warning", "error"
  std::string source;
  std::string text;
};
[[nodiscard]] std::vector<std::uint8_t> ros2_log(const Ros2LogLine& line);

struct Ros2EstimateState {
  std::string state;
  double latency_ms = 0.0;
  std::int32_t map_id = 0;
  /// NaN while not tracking.
  double error_m = 0.0;
  double error_along_m = 0.0;
  double error_across_m = 0.0;
  double error_up_m = 0.0;
  double error_rotation_deg = 0.0;
};
[[nodiscard]] std::vector<std::uint8_t> ros2_estimate_state(const Ros2Header& header,
                                                            const Ros2EstimateState& state);

}  // namespace overfly::server
