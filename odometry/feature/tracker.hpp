// Finds the map's points in a new frame, and the pose from them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera.hpp"
#include "odometry/feature/map.hpp"
#include "odometry/feature/patch_aligner.hpp"
#include "odometry/feature/pose_optimiser.hpp"
#include "odometry/feature/pyramid.hpp"

namespace overfly::odometry {

struct TrackerOptions {
  int max_points = 900;      ///< searched at full detail in a frame
  int coarse_points = 150;   ///< searched first, from coarse to fine
  int local_keyframes = 40;  ///< points last seen in so many newest keyframes are searched
  float min_correlation = 0.8F;
  int min_inliers = 40;
  cv::Mat seen;  ///< CV_8U, 0 where the image shows nothing; empty = it shows ground everywhere
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
  std::vector<TrackedPoint> outliers;  ///< found, but not where the pose puts them
  std::vector<int> missed;             ///< ids searched and not found
  int searched = 0;
  double rms_px = 0.0;
};

/// Searches the local map around a predicted pose.
///
/// Method: projection search of the local map (Mur-Artal, Montiel and Tardos 2015, section V-D),
/// with warped patches aligned in place of descriptors compared, coarse to fine as in Klein and
/// Murray 2007, section 5.
class Tracker {
 public:
  Tracker(const PinholeCamera& camera, const TrackerOptions& options);

  /// @param T_predicted  T_camera_vo to start from
  /// @param coarse_level pyramid level at which the coarse search starts; 0 = the prediction is
  ///                     good enough without one
  [[nodiscard]] TrackResult track(const Pyramid& image,
                                  const Pose& T_predicted,
                                  int coarse_level,
                                  const Map& map) const;

 private:
  struct Projection;
  [[nodiscard]] std::vector<Projection> project(const Pyramid& image,
                                                const Pose& T_camera_vo,
                                                const Map& map) const;
  bool align_coarsely(const Pyramid& image,
                      const std::vector<Projection>& projections,
                      int coarse_level,
                      const Map& map,
                      Pose& T_camera_vo) const;

  PinholeCamera camera_;
  TrackerOptions options_;
};

/// From a view to a source, over a plane through a point. All in the view's camera.
/// @param p, n  the point, and the plane's normal
[[nodiscard]] PatchWarp warp_of(const PinholeCamera& camera,
                                const Pose& T_source_camera,
                                const Eigen::Vector3d& p,
                                const Eigen::Vector3d& n);

/// From a view to the point's source keyframe, over the ground's plane through the point.
[[nodiscard]] PatchWarp warp_of(const PinholeCamera& camera,
                                const Pose& T_camera_vo,
                                const Keyframe& source,
                                const MapPoint& point);

}  // namespace overfly::odometry
