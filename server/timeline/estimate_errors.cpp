#include "server/timeline/estimate_errors.hpp"

#include <algorithm>
#include <cstdint>

namespace overfly::server {
namespace {

constexpr double kLeastSpeed_m_s = 1.0;

/// Direction of the motion between two frames in the horizontal plane; empty if it is too slow.
std::optional<Eigen::Vector2d> heading(const FrameRow& before, const FrameRow& after) {
  const double duration_s = 1e-9 * static_cast<double>(after.t_ns - before.t_ns);
  const Eigen::Vector2d way_m =
      (after.T_world_camera.translation - before.T_world_camera.translation).head<2>();
  if (way_m.norm() < kLeastSpeed_m_s * duration_s || way_m.norm() == 0.0) return std::nullopt;
  return way_m.normalized();
}

EstimateError error_of(const Pose& T_world_camera_estimated,
                       const FrameRow& truth,
                       const std::optional<Eigen::Vector2d>& ahead) {
  const Pose& T_world_camera = truth.T_world_camera;
  const Eigen::Vector3d error_m = T_world_camera_estimated.translation - T_world_camera.translation;
  EstimateError error;
  error.position_m = error_m.norm();
  error.up_m = error_m.z();
  if (ahead) {
    error.along_m = ahead->dot(error_m.head<2>());
    error.across_m = ahead->y() * error_m.x() - ahead->x() * error_m.y();
  }
  error.rotation_rad =
      rotation_angle_rad(T_world_camera.rotation, T_world_camera_estimated.rotation);
  return error;
}

/// Number of recorded frames before frame `frame`.
std::size_t frames_before(const RunTimeline& timeline, std::int64_t frame, std::size_t camera) {
  std::size_t low = 0;
  std::size_t high = timeline.frame_count(camera);
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    const auto row = timeline.frames(middle, 1, camera);
    if (!row.empty() && row.front().frame < frame) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace

std::vector<std::optional<EstimateError>> errors_of(const RunTimeline& timeline,
                                                    std::size_t estimator,
                                                    const std::vector<EstimateRow>& rows,
                                                    const RowAlignment& alignment) {
  std::vector<std::optional<EstimateError>> errors(rows.size());
  if (rows.empty()) return errors;
  const std::size_t camera = camera_of_estimator(timeline, estimator);
  const Pose T_body_camera = timeline.cameras().at(camera).T_body_camera;
  // With one frame before and one after them, for the direction of the motion.
  const std::size_t first = frames_before(timeline, rows.front().sample.frame, camera);
  const std::size_t past = frames_before(timeline, rows.back().sample.frame + 1, camera) + 1;
  const std::size_t begin = first > 0 ? first - 1 : 0;
  const std::vector<FrameRow> frames = timeline.frames(begin, past - begin, camera);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto T_world_body = alignment.T_world_body(rows[i]);
    if (!T_world_body) continue;
    const auto frame = std::lower_bound(
        frames.begin(),
        frames.end(),
        rows[i].sample.frame,
        [](const FrameRow& row, std::int64_t number) { return row.frame < number; });
    if (frame == frames.end() || frame->frame != rows[i].sample.frame) continue;
    const auto before = frame == frames.begin() ? frame : std::prev(frame);
    const auto after = std::next(frame) == frames.end() ? frame : std::next(frame);
    errors[i] = error_of(*T_world_body * T_body_camera, *frame, heading(*before, *after));
  }
  return errors;
}

}  // namespace overfly::server
