#include "flight/mavlink/feedback/feedback_track.hpp"

#include <Eigen/Cholesky>

#include "core/time.hpp"

namespace overfly::flight::mavlink {
namespace {

/// A parabola through fewer positions, or over less time, follows their noise.
constexpr std::size_t kFewestPoints = 4;
constexpr std::int64_t kShortestFitNs = 200'000'000;
/// Positions in use: those of cameras with a high rate are bounded.
constexpr std::size_t kMostPoints = 512;

}  // namespace

bool FeedbackTrack::is_reset(const PlacedEstimate& estimate) const {
  if (lost_ || estimate.map_id != map_id_) return true;
  if (points_.empty()) return false;
  const Point& last = points_.back();
  const Eigen::Vector3d led_to = last.p_world_m + velocity_.value_or(Eigen::Vector3d::Zero()) *
                                                      s_from_ns(estimate.t_ns - last.t_ns);
  return velocity_ && (estimate.T_world_body->translation - led_to).norm() > kJumpM;
}

std::optional<FeedbackSample> FeedbackTrack::take(const PlacedEstimate& estimate) {
  if (!estimate.T_world_body) {
    lost_ = last_ns_.has_value();
    return std::nullopt;
  }
  if (last_ns_ && estimate.t_ns <= *last_ns_) return std::nullopt;
  if (last_ns_ && is_reset(estimate)) {
    ++resets_;
    points_.clear();
  }
  lost_ = false;
  map_id_ = estimate.map_id;
  last_ns_ = estimate.t_ns;
  points_.push_back({estimate.t_ns, estimate.T_world_body->translation});
  while (estimate.t_ns - points_.front().t_ns > kFitNs || points_.size() > kMostPoints) {
    points_.pop_front();
  }
  velocity_ = fit();
  return FeedbackSample{
      estimate.t_ns, *estimate.T_world_body, velocity_, static_cast<std::uint8_t>(resets_)};
}

std::optional<Eigen::Vector3d> FeedbackTrack::fit() const {
  const Point& newest = points_.back();
  if (points_.size() < kFewestPoints || newest.t_ns - points_.front().t_ns < kShortestFitNs) {
    return std::nullopt;
  }
  // p(t) = c0 + c1 t + c2 t^2 with t from the newest position: the velocity there is c1.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d right = Eigen::Matrix3d::Zero();
  for (const Point& point : points_) {
    const double t_s = s_from_ns(point.t_ns - newest.t_ns);
    const Eigen::Vector3d powers(1.0, t_s, t_s * t_s);
    normal += powers * powers.transpose();
    right += powers * (point.p_world_m - newest.p_world_m).transpose();
  }
  const Eigen::Matrix3d coefficients = normal.ldlt().solve(right);
  return Eigen::Vector3d(coefficients.row(1));
}

}  // namespace overfly::flight::mavlink
