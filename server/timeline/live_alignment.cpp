#include "server/timeline/live_alignment.hpp"

#include <cmath>

#include "server/timeline/true_poses.hpp"

namespace overfly::server {
namespace {

std::optional<double> depth_scale_of(const EstimateSample& sample, const FrameRow& frame) {
  if (!frame.axis_depth_m || !sample.scene_depth || !(*sample.scene_depth > 0.0)) {
    return std::nullopt;
  }
  return *frame.axis_depth_m / *sample.scene_depth;
}

}  // namespace

std::optional<Pose> LiveAlignment::add(const EstimateSample& sample,
                                       std::span<const FrameRow> frames) {
  if (sample.state != TrackingState::kTracking) return std::nullopt;
  const auto [entry, is_new] = maps_.try_emplace(sample.map_id);
  Map& map = entry->second;
  if (is_new) map.depth_scale = depth_scale_of(sample, frames.back());
  if (!map.S_world_vo) map.waiting.push_back(sample);
  while (!map.waiting.empty() && map.waiting.front().t_ns <= frames.back().t_ns) {
    const EstimateSample& next = map.waiting.front();
    if (const auto T_world_camera = true_pose_at(frames, next.t_ns)) {
      map.follow({next.t_ns, *T_world_camera, next.T_vo_camera});
    }
    map.waiting.pop_front();
    if (map.S_world_vo) map.waiting.clear();
  }
  S_world_vo_ = map.S_world_vo;
  if (!S_world_vo_) return std::nullopt;
  return *S_world_vo_ * sample.T_vo_camera * T_camera_body_;
}

void LiveAlignment::Map::follow(const Placed& now) {
  if (!first) {
    first = now;
    last = now;
    if (depth_scale) set_scale(*depth_scale);
    return;
  }
  // As in the score, the step that ends after the window does not count.
  if (now.t_ns - first->t_ns <= kPathWindowNs || !path_scale()) step_to(now);
  if (now.t_ns - first->t_ns < kPathWindowNs) return;
  if (const auto scale = path_scale()) set_scale(*scale);
}

void LiveAlignment::Map::step_to(const Placed& now) {
  path_world_m += (now.T_world_camera.translation - last.T_world_camera.translation).norm();
  path_vo += (now.T_vo_camera.translation - last.T_vo_camera.translation).norm();
  last = now;
}

std::optional<double> LiveAlignment::Map::path_scale() const {
  const double scale = path_world_m / path_vo;
  if (!(path_world_m > 0.0 && path_vo > 0.0 && std::isfinite(scale))) return std::nullopt;
  return scale;
}

void LiveAlignment::Map::set_scale(double scale) {
  Similarity S;
  S.scale = scale;
  S.rotation = first->T_world_camera.rotation * first->T_vo_camera.rotation.conjugate();
  S.translation =
      first->T_world_camera.translation - scale * (S.rotation * first->T_vo_camera.translation);
  S_world_vo = S;
}

}  // namespace overfly::server
