// Finds the map's points in a new frame and estimates the pose from them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera/camera.hpp"
#include "odometry/adjustment/pose_optimiser.hpp"
#include "odometry/feature/map/map.hpp"
#include "odometry/image/patch_aligner.hpp"
#include "odometry/image/pyramid.hpp"

namespace overfly::odometry::feature {

struct TrackerOptions {
  int max_points = 900;      ///< searched at full detail per frame
  int coarse_points = 150;   ///< searched first, from coarse to fine
  int local_keyframes = 40;  ///< number of newest keyframes whose points are searched
  float min_correlation = 0.8F;
  int min_inliers = 40;
  cv::Mat seen;  ///< CV_8U, 0 where the image has no data; empty = data everywhere
};

struct TrackedPoint {
  int point = 0;  ///< id
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;
};

struct TrackResult {
  bool tracked = false;
  Pose T_camera_vo;
  std::vector<TrackedPoint> points;    ///< inliers
  std::vector<TrackedPoint> outliers;  ///< found, but inconsistent with the pose
  std::vector<int> missed;             ///< ids of points not found
  int searched = 0;
  double rms_px = 0.0;
};

/// Searches the local map around a predicted pose.
///
/// Method: projection search of the local map (Mur-Artal, Montiel and Tardos 2015, section V-D),
/// with alignment of warped patches instead of descriptor matching, coarse to fine as in Klein and
/// Murray 2007, section 5.
class Tracker {
 public:
  Tracker(const PinholeCamera& camera, const TrackerOptions& options);

  /// @param T_predicted  initial T_camera_vo
  /// @param coarse_level  pyramid level at which the coarse search starts; 0 = the prediction is
  /// good enough without a coarse search
  [[nodiscard]] TrackResult track(const Pyramid& image,
                                  const Pose& T_predicted,
                                  int coarse_level,
                                  const Map& map) const;

 private:
  struct LocalPoint;
  struct Projection;
  /// The points that the newest keyframes observe.
  [[nodiscard]] std::vector<LocalPoint> local_points(const Map& map) const;
  [[nodiscard]] std::vector<Projection> project(const Pyramid& image,
                                                const Pose& T_camera_vo,
                                                const std::vector<LocalPoint>& local) const;
  bool align_coarsely(const Pyramid& image,
                      const std::vector<Projection>& projections,
                      int coarse_level,
                      const Map& map,
                      Pose& T_camera_vo) const;

  PinholeCamera camera_;
  TrackerOptions options_;
};

/// Warp from a view to a source view over a plane through a point. All in the view's camera frame.
/// @param p, n  the point and the plane's normal
[[nodiscard]] PatchWarp warp_of(const PinholeCamera& camera,
                                const Pose& T_source_camera,
                                const Eigen::Vector3d& p,
                                const Eigen::Vector3d& n);

/// Warp from a view to the point's source keyframe over the ground plane through the point.
[[nodiscard]] PatchWarp warp_of(const PinholeCamera& camera,
                                const Pose& T_camera_vo,
                                const Keyframe& source,
                                const MapPoint& point);

}  // namespace overfly::odometry::feature
