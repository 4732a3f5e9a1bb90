// The map: keyframes, and ground points observed in them.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/motion/pose.hpp"
#include "odometry/feature/map/id_table.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/geometry/lie.hpp"
#include "odometry/image/pyramid.hpp"

namespace overfly::odometry::feature {

/// Standard deviation of the pixel noise of a patch found at a pyramid level [px].
[[nodiscard]] inline double sigma_px_of(int patch_level) { return std::ldexp(0.2, patch_level); }

/// Observation of a map point in a keyframe.
struct Observation {
  int point = 0;  ///< id
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;
};

/// A corner of a keyframe without depth.
struct Candidate {
  Corner corner;
  Descriptor descriptor{};
  int patch_level = 0;  ///< pyramid level at which it is searched
  int misses = 0;       ///< keyframes in which it was not found
  bool done = false;
};

/// The ground as a plane in a camera frame: inverse depth = a x + b y + c at the ray (x, y, 1).
struct GroundPlane {
  Eigen::Vector3d coefficients{0.0, 0.0, 1.0};  ///< (a, b, c), also the plane's unscaled normal
  bool holds = true;                            ///< the observed points lie near the plane
  double median_depth = 1.0;                    ///< of the observed points

  [[nodiscard]] double inverse_depth(const Eigen::Vector3d& ray) const {
    return coefficients.dot(ray);
  }
};

struct Keyframe {
  int id = 0;
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
  Pose T_camera_vo;
  Pyramid pyramid;  ///< emptied when the keyframe is too old to be searched
  std::vector<Observation> observations;
  std::vector<Candidate> candidates;
  GroundPlane plane;
};

struct MapPoint {
  int id = 0;
  int source_keyframe = 0;  ///< keyframe whose image contains its patch
  Eigen::Vector2d source_pixel = Eigen::Vector2d::Zero();
  Eigen::Vector3d normal_vo = Eigen::Vector3d::UnitZ();  ///< ground normal at the point
  Descriptor descriptor{};
  Eigen::Vector3d position_vo = Eigen::Vector3d::Zero();
  std::vector<int> keyframes;  ///< ids of observing keyframes, ascending
  int patch_level = 0;         ///< pyramid level at which it is searched
  int expected = 0;            ///< frames in which it should have been found
  int found = 0;               ///< frames in which it was found
};

/// Ids increase and are never reused. Iteration is in order of ids, so that results are
/// reproducible.
class Map {
 public:
  Keyframe& add_keyframe(Keyframe keyframe);
  MapPoint& add_point(MapPoint point);
  void add_observation(Keyframe& keyframe, const Observation& observation);
  /// Removes one observation of a point. A point with fewer than two observations is removed.
  void remove_observation(int keyframe, int point);
  void remove_point(int point);
  /// Removes the images of all but the newest keyframes, the points whose patch is in them, and
  /// keyframes without points.
  void forget_images(int keep_newest);
  /// Copies the part that tracking needs: the newest `keyframes` keyframes and the points whose
  /// patch is in them. Only the newest keyframe has observations, and none has candidates. Images
  /// are shared with this map.
  [[nodiscard]] Map newest_part(int keyframes) const;
  /// Memory of images, points, observations and candidates [bytes].
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Of these, those of images.
  [[nodiscard]] std::size_t image_bytes() const;

  [[nodiscard]] std::map<int, Keyframe>& keyframes() { return keyframes_; }
  [[nodiscard]] const std::map<int, Keyframe>& keyframes() const { return keyframes_; }
  [[nodiscard]] IdTable<MapPoint>& points() { return points_; }
  [[nodiscard]] const IdTable<MapPoint>& points() const { return points_; }
  [[nodiscard]] Keyframe& keyframe(int id) { return keyframes_.at(id); }
  [[nodiscard]] const Keyframe& keyframe(int id) const { return keyframes_.at(id); }
  /// Null if the point was removed.
  [[nodiscard]] MapPoint* point(int id) { return points_.find(id); }
  [[nodiscard]] const MapPoint* point(int id) const { return points_.find(id); }
  /// @pre the map is not empty
  [[nodiscard]] Keyframe& newest() { return keyframes_.rbegin()->second; }
  [[nodiscard]] const Keyframe& newest() const { return keyframes_.rbegin()->second; }

  /// Keyframes that share points with `keyframe`, by number of shared points, then newest first.
  [[nodiscard]] std::vector<int> covisible(int keyframe, int min_shared) const;

 private:
  std::map<int, Keyframe> keyframes_;
  IdTable<MapPoint> points_;
  int next_keyframe_ = 0;
  int next_point_ = 0;
  int first_with_image_ = 0;
};

/// The point that a keyframe already observes at a pixel, within 1.5 px at the finer of the two
/// patch levels; null if none.
[[nodiscard]] const MapPoint* point_at(const Map& map,
                                       const Keyframe& keyframe,
                                       const Eigen::Vector2d& pixel,
                                       int patch_level);

/// Sets the ground normal at a point from the ground plane of its source keyframe.
void set_normal(const PinholeCamera& camera, const Keyframe& source, MapPoint& point);

/// Robustly fits the ground plane to the keyframe's points and sets whether they lie near it. With
/// too few points the old plane is kept.
void fit_plane(const PinholeCamera& camera, const Map& map, Keyframe& keyframe);

/// Depth of the ground on the camera's optical axis. The alignment `init_scale` compares it with
/// the truth. Uses a plane through the points near the axis if there are enough of them, otherwise
/// the median depth of all points. Empty if no point is in front.
[[nodiscard]] std::optional<double> axis_depth(const Pose& T_camera_vo,
                                               const std::vector<Eigen::Vector3d>& points_vo);

}  // namespace overfly::odometry::feature
