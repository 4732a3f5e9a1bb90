// Bundle adjustment: poses and points together.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera.hpp"
#include "core/pose.hpp"
#include "odometry/feature/map.hpp"

namespace overfly::odometry {

/// A problem by indices, independent of the map.
struct Bundle {
  struct Camera {
    Pose T_camera_vo;
    bool fixed = false;
  };
  struct Sight {
    int camera = 0;
    int point = 0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    double sigma_px = 1.0;
  };
  std::vector<Camera> cameras;
  std::vector<Eigen::Vector3d> points_vo;
  std::vector<Sight> sights;
};

struct BundleOptions {
  int max_iterations = 5;
  double huber = 2.0;  ///< residual, in sigmas, from which weight falls
};

/// Minimises the reprojection error over the free cameras and all points.
///
/// Method: Levenberg-Marquardt with the Schur complement over the points (Triggs et al. 2000,
/// section 6.1) by Ceres, analytic derivatives, one thread: results repeat.
/// @return root of the mean squared residual after it, in sigmas; infinite where a sight's point is
/// not in front of its camera, which leaves all as it was
double adjust(const PinholeCamera& camera, Bundle& bundle, const BundleOptions& options);

/// Adjusts the newest keyframe, those most covisible with it, and all points that these see; other
/// keyframes that see the points are held (Mur-Artal and Tardos 2017, section III-B, eq. 3).
/// Sights that then miss by more than `outlier` sigmas are removed.
struct LocalAdjustment {
  int free_keyframes = 8;
  int fixed_keyframes = 12;  ///< at most so many held
  double outlier = 6.0;
  BundleOptions solver;
};
void adjust_locally(const PinholeCamera& camera, const LocalAdjustment& options, Map& map);

}  // namespace overfly::odometry
