#include "server/timeline/window_errors.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "core/time.hpp"
#include "server/timeline/count_frames.hpp"

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

std::vector<FrameRow> frames_between(const RunTimeline& timeline,
                                     std::size_t camera,
                                     std::int64_t first_frame,
                                     std::int64_t last_frame) {
  const std::size_t begin =
      count_frames(timeline, camera, [&](const FrameRow& row) { return row.frame < first_frame; });
  const std::size_t end =
      count_frames(timeline, camera, [&](const FrameRow& row) { return row.frame <= last_frame; });
  return timeline.frames(begin, end - std::min(begin, end), camera);
}

/// As MatchedPose::detour_m, from the frames in between.
double detour_between_m(std::vector<FrameRow>::const_iterator from,
                        std::vector<FrameRow>::const_iterator to) {
  if (to->t_ns - from->t_ns <= kNsPerS) return 0.0;
  const Eigen::Vector3d way_m = to->T_world_camera.translation - from->T_world_camera.translation;
  double path_m = 0.0;
  for (; from != to; ++from) {
    path_m +=
        (std::next(from)->T_world_camera.translation - from->T_world_camera.translation).norm();
  }
  return std::max(0.0, path_m - way_m.norm());
}

std::vector<std::optional<PosePair>> poses_of(const std::vector<EstimateRow>& rows,
                                              const std::vector<FrameRow>& frames,
                                              const RowAlignment& alignment,
                                              const Pose& T_body_camera) {
  std::vector<std::optional<PosePair>> poses(rows.size());
  auto frame = frames.begin();
  auto last = frames.end();  // of the pose before
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const EstimateSample& sample = rows[i].sample;
    while (frame != frames.end() && frame->frame < sample.frame) ++frame;
    if (frame == frames.end() || frame->frame != sample.frame) continue;
    if (const auto T_world_body = alignment.T_world_body(rows[i])) {
      const double detour_m = last == frames.end() ? 0.0 : detour_between_m(last, frame);
      poses[i] = {sample.map_id, frame->T_world_camera, *T_world_body * T_body_camera, detour_m};
      last = frame;
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
  const std::vector<FrameRow> frames =
      frames_between(timeline, camera, all.front().sample.frame, all.back().sample.frame);
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
