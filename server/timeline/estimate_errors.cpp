#include "server/timeline/estimate_errors.hpp"

#include <cstdint>

#include "server/timeline/true_poses.hpp"

namespace overfly::server {
namespace {

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
  const StampRange stamps = stamps_of(rows);
  // Those before the rows give the path its direction.
  const std::vector<FrameRow> frames =
      frames_around(timeline, camera, stamps.first_ns - evaluation::kPathWindowNs, stamps.last_ns);
  Trajectory truth;
  for (const FrameRow& frame : frames) {
    // A pose that a trajectory cannot hold is left out.
    static_cast<void>(truth.append({frame.t_ns, frame.T_world_camera}));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto T_world_body = alignment.T_world_body(rows[i]);
    if (!T_world_body) continue;
    const std::int64_t t_ns = rows[i].sample.t_ns;
    const std::optional<Pose> T_world_camera = true_pose_at(frames, t_ns);
    if (!T_world_camera) continue;
    const Pose estimated = *T_world_body * T_body_camera;
    errors[i] = {
        evaluation::axis_error(truth, t_ns, *T_world_camera, estimated.translation, T_body_camera),
        rotation_angle_rad(T_world_camera->rotation, estimated.rotation),
        position_nees(rows[i].sample, alignment.scale(rows[i]), estimated, *T_world_camera)};
  }
  return errors;
}

}  // namespace overfly::server
