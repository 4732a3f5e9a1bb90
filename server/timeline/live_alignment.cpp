#include "server/timeline/live_alignment.hpp"

namespace overfly::server {

std::optional<Pose> LiveAlignment::add(const EstimateSample& sample,
                                       const Pose& T_world_camera,
                                       const std::optional<double>& axis_depth_m) {
  if (sample.state != TrackingState::kTracking) return std::nullopt;
  auto map = maps_.find(sample.map_id);
  if (map == maps_.end()) {
    map = maps_.emplace(sample.map_id, begin_map(sample, T_world_camera, axis_depth_m)).first;
  } else if (!map->second.S_world_vo) {
    map->second.measure_path(sample, T_world_camera);
  }
  S_world_vo_ = map->second.S_world_vo;
  if (!S_world_vo_) return std::nullopt;
  return *S_world_vo_ * sample.T_vo_camera * T_camera_body_;
}

LiveAlignment::Map LiveAlignment::begin_map(const EstimateSample& sample,
                                            const Pose& T_world_camera,
                                            const std::optional<double>& axis_depth_m) {
  Map map;
  map.T_world_camera_first = T_world_camera;
  map.T_vo_camera_first = sample.T_vo_camera;
  map.first_t_ns = sample.t_ns;
  map.last_p_world = T_world_camera.translation;
  map.last_p_vo = sample.T_vo_camera.translation;
  if (axis_depth_m && sample.scene_depth && *sample.scene_depth > 0.0) {
    map.set_scale(*axis_depth_m / *sample.scene_depth);
  }
  return map;
}

void LiveAlignment::Map::measure_path(const EstimateSample& sample, const Pose& T_world_camera) {
  path_world_m += (T_world_camera.translation - last_p_world).norm();
  path_vo += (sample.T_vo_camera.translation - last_p_vo).norm();
  last_p_world = T_world_camera.translation;
  last_p_vo = sample.T_vo_camera.translation;
  if (sample.t_ns - first_t_ns >= kPathWindowNs && path_vo > 0.0) {
    set_scale(path_world_m / path_vo);
  }
}

void LiveAlignment::Map::set_scale(double scale) {
  Similarity S;
  S.scale = scale;
  S.rotation = T_world_camera_first.rotation * T_vo_camera_first.rotation.conjugate();
  S.translation =
      T_world_camera_first.translation - scale * (S.rotation * T_vo_camera_first.translation);
  S_world_vo = S;
}

}  // namespace overfly::server
