// The alignment `init_scale` during the run: places an estimate in the world from its first tracked
// frame on, without waiting for the end.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>

#include "core/motion/estimate.hpp"
#include "core/motion/pose.hpp"
#include "server/record/rows/rows.hpp"

namespace overfly::server {

/// Takes every answer of one estimator in order. Each map has an alignment of its own, which it
/// keeps when the estimator returns to it. As in the score, the truth of an answer is that at its
/// stamp: while a fault lets the camera's clock run ahead, answers wait for it.
class LiveAlignment {
 public:
  /// Without a scene depth the scale comes from the path length over the first 5 s of tracking, or
  /// more if truth or estimate do not move in them; until then rows have no pose in the world.
  static constexpr std::int64_t kPathWindowNs = 5'000'000'000;

  /// @param T_body_camera  the camera's mount
  explicit LiveAlignment(const Pose& T_body_camera) : T_camera_body_(T_body_camera.inverse()) {}

  /// @param frames  of the estimator's camera: up to the sample's own, which is the last
  /// @return estimated T_world_body; empty while not tracking or not aligned
  std::optional<Pose> add(const EstimateSample& sample, std::span<const FrameRow> frames);

  /// S_world_vo of the map that was tracked last.
  [[nodiscard]] const std::optional<Similarity>& S_world_vo() const { return S_world_vo_; }

 private:
  /// An answer and the truth at its stamp.
  struct Placed {
    std::int64_t t_ns = 0;
    Pose T_world_camera;
    Pose T_vo_camera;
  };
  struct Map {
    /// True depth / scene depth of the first tracked frame; empty if one of them is not known.
    std::optional<double> depth_scale;
    std::deque<EstimateSample> waiting;  ///< for their truth
    std::optional<Placed> first;
    Placed last;
    double path_world_m = 0.0;  ///< from the first to the last
    double path_vo = 0.0;
    std::optional<Similarity> S_world_vo;

    void follow(const Placed& now);
    void step_to(const Placed& now);
    void set_scale(double scale);
    [[nodiscard]] std::optional<double> path_scale() const;
  };

  Pose T_camera_body_;
  std::map<int, Map> maps_;  ///< by map_id
  std::optional<Similarity> S_world_vo_;
};

}  // namespace overfly::server
