#include "server/timeline/estimate_errors.hpp"

#include <algorithm>
#include <cstdint>

#include "server/timeline/count_frames.hpp"

namespace overfly::server {
namespace {

/// The frames of the rows, and those before them that give the path its direction.
std::vector<FrameRow> frames_of(const RunTimeline& timeline,
                                std::size_t camera,
                                const std::vector<EstimateRow>& rows) {
  const std::int64_t first_frame = rows.front().sample.frame;
  const std::int64_t last_frame = rows.back().sample.frame;
  const std::size_t first =
      count_frames(timeline, camera, [&](const FrameRow& row) { return row.frame < first_frame; });
  const std::vector<FrameRow> first_row = timeline.frames(first, 1, camera);
  if (first_row.empty()) return {};
  const std::int64_t begin_ns = first_row.front().t_ns - evaluation::kPathWindowNs;
  const std::size_t past_begin =
      count_frames(timeline, camera, [&](const FrameRow& row) { return row.t_ns <= begin_ns; });
  const std::size_t begin = past_begin > 0 ? past_begin - 1 : 0;
  const std::size_t end =
      count_frames(timeline, camera, [&](const FrameRow& row) { return row.frame <= last_frame; });
  return timeline.frames(begin, end - std::min(begin, end), camera);
}

/// @param estimated  T_world_camera of the row
std::optional<double> position_nees(const EstimateSample& sample,
                                    double scale,
                                    const Pose& estimated,
                                    const Pose& truth) {
  if (sample.covariance == nullptr) return std::nullopt;
  Similarity S_world_vo;
  S_world_vo.scale = scale;
  S_world_vo.rotation = estimated.rotation * sample.T_vo_camera.rotation.conjugate();
  const Matrix6d P = in_target(S_world_vo, sample.covariance->matrix);
  return squared_deviation(Eigen::Vector3d(truth.translation - estimated.translation),
                           Eigen::Matrix3d(P.topLeftCorner<3, 3>()));
}

}  // namespace

evaluation::Band position_nees_band() { return evaluation::nees_band_95(3, 1); }

std::vector<std::optional<EstimateError>> errors_of(const RunTimeline& timeline,
                                                    std::size_t estimator,
                                                    const std::vector<EstimateRow>& rows,
                                                    const RowAlignment& alignment) {
  std::vector<std::optional<EstimateError>> errors(rows.size());
  if (rows.empty()) return errors;
  const std::size_t camera = camera_of_estimator(timeline, estimator);
  const Pose T_body_camera = timeline.cameras().at(camera).T_body_camera;
  const std::vector<FrameRow> frames = frames_of(timeline, camera, rows);
  Trajectory truth;
  for (const FrameRow& frame : frames) {
    // A pose that a trajectory cannot hold is left out.
    static_cast<void>(truth.append({frame.t_ns, frame.T_world_camera}));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto T_world_body = alignment.T_world_body(rows[i]);
    if (!T_world_body) continue;
    const auto frame = std::lower_bound(
        frames.begin(),
        frames.end(),
        rows[i].sample.frame,
        [](const FrameRow& row, std::int64_t number) { return row.frame < number; });
    if (frame == frames.end() || frame->frame != rows[i].sample.frame) continue;
    const Pose estimated = *T_world_body * T_body_camera;
    errors[i] = {
        evaluation::axis_error(
            truth, frame->t_ns, frame->T_world_camera, estimated.translation, T_body_camera),
        rotation_angle_rad(frame->T_world_camera.rotation, estimated.rotation),
        position_nees(rows[i].sample, alignment.scale(rows[i]), estimated, frame->T_world_camera)};
  }
  return errors;
}

}  // namespace overfly::server
