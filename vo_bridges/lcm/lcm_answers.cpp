#include "vo_bridges/lcm/lcm_answers.hpp"

#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace overfly {
namespace {

/// Tolerance of a quaternion's norm: components with four decimals, as in many text files.
constexpr double kQuaternionTolerance = 1e-3;

Error unreadable(const std::string& field, const std::string& value, const std::string& limit) {
  return {ErrorCode::kUnreadable, field + " = " + value + ": must be " + limit};
}

std::optional<TrackingState> state_from(std::int8_t state) {
  switch (state) {
    case overfly_lcm::pose_t::INITIALISING:
      return TrackingState::kInitialising;
    case overfly_lcm::pose_t::TRACKING:
      return TrackingState::kTracking;
    case overfly_lcm::pose_t::LOST:
      return TrackingState::kLost;
    default:
      return std::nullopt;
  }
}

Result<Pose> pose_from(const overfly_lcm::pose_t& message) {
  const Eigen::Map<const Eigen::Vector3d> position(message.position);
  if (!position.allFinite()) return unreadable("position", "not finite", "finite");
  const double* const q = message.orientation;
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  const double norm = rotation.norm();
  if (!(std::abs(norm - 1.0) <= kQuaternionTolerance)) {
    return unreadable("norm of orientation", std::to_string(norm), "1 (x y z w)");
  }
  return Pose{rotation.normalized(), position};
}

std::map<std::string, double> numbers_from(const std::vector<overfly_lcm::named_number_t>& list) {
  std::map<std::string, double> numbers;
  for (const auto& [name, value] : list) {
    if (std::isfinite(value)) numbers[name] = value;
  }
  return numbers;
}

}  // namespace

Result<VoEstimate> estimate_from(const overfly_lcm::pose_t& message) {
  VoEstimate estimate;
  estimate.sample.frame = message.frame;
  estimate.sample.t_ns = message.t_ns;
  const std::optional<TrackingState> state = state_from(message.state);
  if (!state) return unreadable("state", std::to_string(message.state), "0, 1 or 2");
  estimate.sample.state = *state;
  if (message.map_id < 0) return unreadable("map_id", std::to_string(message.map_id), "0 or more");
  estimate.sample.map_id = message.map_id;
  if (*state == TrackingState::kTracking) {
    const Result<Pose> pose = pose_from(message);
    if (!pose) return pose.error();
    estimate.sample.T_vo_camera = *pose;
  }
  if (std::isfinite(message.scene_depth) && message.scene_depth > 0.0) {
    estimate.sample.scene_depth = message.scene_depth;
  }
  estimate.counters = numbers_from(message.counters);
  estimate.timing_ms = numbers_from(message.timings_ms);
  if (message.image_crc32 >= 0) {
    estimate.image_crc32 = static_cast<std::uint32_t>(message.image_crc32);
  }
  return estimate;
}

Result<DebugView> debug_view_from(const overfly_lcm::debug_t& message,
                                  int largest_width_px,
                                  int largest_height_px) {
  DebugView view;
  for (const std::vector<float>& point : message.points) {
    const Eigen::Vector3f p_vo(point[0], point[1], point[2]);
    if (p_vo.allFinite()) view.map_points_vo.push_back(p_vo);
  }
  if (message.size == 0) return view;
  if (message.width < 1 || message.width > largest_width_px) {
    return unreadable(
        "width", std::to_string(message.width), "in [1, " + std::to_string(largest_width_px) + "]");
  }
  if (message.height < 1 || message.height > largest_height_px) {
    return unreadable("height",
                      std::to_string(message.height),
                      "in [1, " + std::to_string(largest_height_px) + "]");
  }
  Image image(message.width, message.height, 3);
  if (message.data.size() != image.data.size()) {
    return unreadable(
        "size", std::to_string(message.size), std::to_string(image.data.size()) + " (RGB)");
  }
  image.data = message.data;
  view.image = std::move(image);
  return view;
}

}  // namespace overfly
