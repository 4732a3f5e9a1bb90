// The alignment `init_scale` during the run: places an estimate in the world from its first tracked
// frame on, without waiting for the end.
#pragma once

#include <cstdint>
#include <optional>

#include "core/motion/estimate.hpp"
#include "core/motion/pose.hpp"

namespace overfly::server {

/// Takes every answer of one estimator in order. A new map (reset) starts a new alignment.
class LiveAlignment {
 public:
  /// Without a scene depth the scale comes from the path length over the first 5 s of tracking;
  /// until then rows have no pose in the world.
  static constexpr std::int64_t kPathWindowNs = 5'000'000'000;

  /// @param T_body_camera  the camera's mount
  explicit LiveAlignment(const Pose& T_body_camera) : T_camera_body_(T_body_camera.inverse()) {}

  /// @param T_world_camera  truth at the sample's frame
  /// @param axis_depth_m  true depth along the optical axis at that frame
  /// @return estimated T_world_body; empty while not tracking or not aligned
  std::optional<Pose> add(const EstimateSample& sample,
                          const Pose& T_world_camera,
                          const std::optional<double>& axis_depth_m);

  /// True depth at the first tracked frame of the first map [m].
  [[nodiscard]] const std::optional<double>& init_true_depth_m() const {
    return init_true_depth_m_;
  }
  /// Scene depth that the estimator reported at that frame, vo units.
  [[nodiscard]] const std::optional<double>& init_scene_depth() const { return init_scene_depth_; }
  /// S_world_vo of the current map.
  [[nodiscard]] const std::optional<Similarity>& S_world_vo() const { return S_world_vo_; }

 private:
  void begin_map(const EstimateSample& sample,
                 const Pose& T_world_camera,
                 const std::optional<double>& axis_depth_m);
  void measure_path(const EstimateSample& sample, const Pose& T_world_camera);
  void set_scale(double scale);

  Pose T_camera_body_;
  std::optional<int> map_id_;
  bool first_map_ = true;
  Pose T_world_camera_first_;
  Pose T_vo_camera_first_;
  std::int64_t first_t_ns_ = 0;
  Eigen::Vector3d last_p_world_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_p_vo_ = Eigen::Vector3d::Zero();
  double path_world_m_ = 0.0;
  double path_vo_ = 0.0;
  std::optional<Similarity> S_world_vo_;
  std::optional<double> init_true_depth_m_;
  std::optional<double> init_scene_depth_;
};

}  // namespace overfly::server
