#include "server/timeline/window_errors.hpp"

#include <algorithm>
#include <cstdint>

#include "core/motion/trajectory.hpp"
#include "core/time.hpp"
#include "server/timeline/count_frames.hpp"
#include "server/timeline/true_poses.hpp"

namespace overfly::server {
namespace {

using evaluation::kMaxWindowPoses;
using evaluation::PosePair;

/// The rows before `first_frame`, at most kMaxWindowPoses.
std::vector<EstimateRow> rows_before(const RunTimeline& timeline,
                                     std::size_t estimator,
                                     std::int64_t first_frame) {
  const std::size_t end = count_rows(timeline.estimate_count(estimator), [&](std::size_t i) {
    const auto row = timeline.estimates(estimator, i, 1);
    return !row.empty() && row.front().sample.frame < first_frame;
  });
  const std::size_t count = std::min(end, kMaxWindowPoses);
  return timeline.estimates(estimator, end - count, count);
}

/// As MatchedPose::detour_m, from the frames in between.
double detour_between_m(const StampedPose& from,
                        const StampedPose& to,
                        const std::vector<FrameRow>& frames) {
  if (to.t_ns - from.t_ns <= kNsPerS) return 0.0;
  auto frame = std::upper_bound(
      frames.begin(), frames.end(), from.t_ns, [](std::int64_t t_ns, const FrameRow& row) {
        return t_ns < row.t_ns;
      });
  Eigen::Vector3d last_m = from.pose.translation;
  double path_m = 0.0;
  for (; frame != frames.end() && frame->t_ns < to.t_ns; ++frame) {
    path_m += (frame->T_world_camera.translation - last_m).norm();
    last_m = frame->T_world_camera.translation;
  }
  path_m += (to.pose.translation - last_m).norm();
  return std::max(0.0, path_m - (to.pose.translation - from.pose.translation).norm());
}

std::vector<std::optional<PosePair>> poses_of(const std::vector<EstimateRow>& rows,
                                              const std::vector<FrameRow>& frames,
                                              const RowAlignment& alignment,
                                              const Pose& T_body_camera) {
  std::vector<std::optional<PosePair>> poses(rows.size());
  std::optional<StampedPose> last;  // truth of the pose before
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const EstimateSample& sample = rows[i].sample;
    const std::optional<Pose> T_world_camera = true_pose_at(frames, sample.t_ns);
    if (!T_world_camera) continue;
    if (const auto T_world_body = alignment.T_world_body(rows[i])) {
      const StampedPose now{sample.t_ns, *T_world_camera};
      const double detour_m = last ? detour_between_m(*last, now, frames) : 0.0;
      poses[i] = {sample.map_id, *T_world_camera, *T_world_body * T_body_camera, detour_m};
      last = now;
    }
  }
  return poses;
}

}  // namespace

std::vector<WindowErrors> window_errors_of(const RunTimeline& timeline,
                                           std::size_t estimator,
                                           const std::vector<EstimateRow>& rows,
                                           const RowAlignment& alignment) {
  std::vector<WindowErrors> errors(rows.size());
  if (rows.empty()) return errors;
  std::vector<EstimateRow> all = rows_before(timeline, estimator, rows.front().sample.frame);
  const std::size_t earlier = all.size();
  all.insert(all.end(), rows.begin(), rows.end());
  const std::size_t camera = camera_of_estimator(timeline, estimator);
  const StampRange stamps = stamps_of(all);
  const std::vector<FrameRow> frames =
      frames_around(timeline, camera, stamps.first_ns, stamps.last_ns);
  const std::vector<std::optional<PosePair>> poses =
      poses_of(all, frames, alignment, timeline.cameras().at(camera).T_body_camera);
  const auto relative = evaluation::relative_errors_along(poses);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!poses[earlier + i]) continue;
    errors[i] = {evaluation::scale_error_at(poses, earlier + i), relative[earlier + i]};
  }
  return errors;
}

}  // namespace overfly::server
