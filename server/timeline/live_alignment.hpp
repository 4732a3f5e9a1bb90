// The alignment `init_scale` during the run: places an estimate in the world from its first tracked
// frame on, without waiting for the end.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "core/motion/estimate.hpp"
#include "core/motion/pose.hpp"

namespace overfly::server {

/// Takes every answer of one estimator in order. Each map has an alignment of its own, which it
/// keeps when the estimator returns to it.
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

  /// S_world_vo of the map that was tracked last.
  [[nodiscard]] const std::optional<Similarity>& S_world_vo() const { return S_world_vo_; }

 private:
  struct Map {
    Pose T_world_camera_first;
    Pose T_vo_camera_first;
    std::int64_t first_t_ns = 0;
    Eigen::Vector3d last_p_world = Eigen::Vector3d::Zero();
    Eigen::Vector3d last_p_vo = Eigen::Vector3d::Zero();
    double path_world_m = 0.0;
    double path_vo = 0.0;
    std::optional<Similarity> S_world_vo;

    void measure_path(const EstimateSample& sample, const Pose& T_world_camera);
    void set_scale(double scale);
  };
  /// The alignment of a map that is tracked for the first time.
  static Map begin_map(const EstimateSample& sample,
                       const Pose& T_world_camera,
                       const std::optional<double>& axis_depth_m);

  Pose T_camera_body_;
  std::map<int, Map> maps_;  ///< by map_id
  std::optional<Similarity> S_world_vo_;
};

}  // namespace overfly::server
