#include "evaluation/axis_errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace overfly::evaluation {
namespace {

constexpr std::int64_t kHalfWindowNs = 250'000'000;
constexpr double kLeastMotionM = 0.05;

/// The truth at t, or at `otherwise_ns` where it has no pose at t.
Eigen::Vector3d place_near(const Trajectory& truth,
                           std::int64_t t_ns,
                           const Eigen::Vector3d& otherwise) {
  const std::int64_t inside_ns = std::clamp(t_ns, truth.begin_ns(), truth.end_ns());
  const std::optional<Pose> pose = truth.at(inside_ns);
  return pose ? pose->translation : otherwise;
}

/// Horizontal unit vector of the motion around a match; empty if it hardly moves.
std::optional<Eigen::Vector2d> direction_at(const Trajectory& truth, const MatchedPose& match) {
  if (truth.empty()) return std::nullopt;
  const Eigen::Vector3d& here = match.T_world_camera.translation;
  const Eigen::Vector3d before = place_near(truth, match.t_ns - kHalfWindowNs, here);
  const Eigen::Vector3d after = place_near(truth, match.t_ns + kHalfWindowNs, here);
  const Eigen::Vector2d motion = (after - before).head<2>();
  const double length_m = motion.norm();
  if (!(length_m >= kLeastMotionM)) return std::nullopt;
  return motion / length_m;
}

/// The direction at each match, with those that are not determined filled in.
std::vector<Eigen::Vector2d> directions_of(const Trajectory& truth,
                                           const std::vector<MatchedPose>& matches) {
  std::vector<Eigen::Vector2d> directions;
  std::optional<Eigen::Vector2d> last;
  for (const MatchedPose& match : matches) {
    if (const auto direction = direction_at(truth, match)) {
      if (!last) std::fill(directions.begin(), directions.end(), *direction);
      last = direction;
    }
    directions.push_back(last.value_or(Eigen::Vector2d::UnitX()));
  }
  return directions;
}

}  // namespace

std::vector<AxisError> axis_errors(const Trajectory& T_world_camera_truth,
                                   const std::vector<MatchedPose>& matches,
                                   const Similarity& S_world_vo) {
  const std::vector<Eigen::Vector2d> directions = directions_of(T_world_camera_truth, matches);
  std::vector<AxisError> errors;
  errors.reserve(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector3d error =
        S_world_vo * matches[i].T_vo_camera.translation - matches[i].T_world_camera.translation;
    const Eigen::Vector2d& along = directions[i];
    const Eigen::Vector2d right(along.y(), -along.x());
    errors.push_back(
        {matches[i].t_ns, error.head<2>().dot(along), error.head<2>().dot(right), error.z()});
  }
  return errors;
}

AxisRmse rmse_of(const std::vector<AxisError>& errors) {
  if (errors.empty()) return {};
  double along = 0.0;
  double across = 0.0;
  double up = 0.0;
  for (const AxisError& error : errors) {
    along += error.along_m * error.along_m;
    across += error.across_m * error.across_m;
    up += error.up_m * error.up_m;
  }
  const auto count = static_cast<double>(errors.size());
  return {std::sqrt(along / count),
          std::sqrt(across / count),
          std::sqrt((along + across) / count),
          std::sqrt(up / count)};
}

}  // namespace overfly::evaluation
