#include "server/timeline/live_alignment.hpp"

namespace overfly::server {

std::optional<Pose> LiveAlignment::add(const EstimateSample& sample,
                                       const Pose& T_world_camera,
                                       const std::optional<double>& axis_depth_m) {
  if (sample.state != TrackingState::kTracking) return std::nullopt;
  if (map_id_ != sample.map_id) {
    begin_map(sample, T_world_camera, axis_depth_m);
  } else if (!S_world_vo_) {
    measure_path(sample, T_world_camera);
  }
  if (!S_world_vo_) return std::nullopt;
  return *S_world_vo_ * sample.T_vo_camera * T_camera_body_;
}

void LiveAlignment::begin_map(const EstimateSample& sample,
                              const Pose& T_world_camera,
                              const std::optional<double>& axis_depth_m) {
  map_id_ = sample.map_id;
  T_world_camera_first_ = T_world_camera;
  T_vo_camera_first_ = sample.T_vo_camera;
  first_t_ns_ = sample.t_ns;
  last_p_world_ = T_world_camera.translation;
  last_p_vo_ = sample.T_vo_camera.translation;
  path_world_m_ = 0.0;
  path_vo_ = 0.0;
  S_world_vo_.reset();
  if (first_map_) {
    init_true_depth_m_ = axis_depth_m;
    init_scene_depth_ = sample.scene_depth;
    first_map_ = false;
  }
  if (axis_depth_m && sample.scene_depth && *sample.scene_depth > 0.0) {
    set_scale(*axis_depth_m / *sample.scene_depth);
  }
}

void LiveAlignment::measure_path(const EstimateSample& sample, const Pose& T_world_camera) {
  path_world_m_ += (T_world_camera.translation - last_p_world_).norm();
  path_vo_ += (sample.T_vo_camera.translation - last_p_vo_).norm();
  last_p_world_ = T_world_camera.translation;
  last_p_vo_ = sample.T_vo_camera.translation;
  if (sample.t_ns - first_t_ns_ >= kPathWindowNs && path_vo_ > 0.0) {
    set_scale(path_world_m_ / path_vo_);
  }
}

void LiveAlignment::set_scale(double scale) {
  Similarity S;
  S.scale = scale;
  S.rotation = T_world_camera_first_.rotation * T_vo_camera_first_.rotation.conjugate();
  S.translation =
      T_world_camera_first_.translation - scale * (S.rotation * T_vo_camera_first_.translation);
  S_world_vo_ = S;
}

}  // namespace overfly::server
