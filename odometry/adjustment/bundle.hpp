// Bundle adjustment of poses and points.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/motion/pose.hpp"

namespace overfly::odometry {

/// A bundle adjustment problem in terms of indices, independent of the map.
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
  double huber = 2.0;  ///< residual from which the weight decreases [sigmas]
};

/// Minimises the reprojection error over the free cameras and all points.
///
/// Method: Levenberg-Marquardt with the Schur complement over the points (Triggs et al. 2000,
/// section 6.1) using Ceres, with analytic derivatives and one thread, so that results are
/// reproducible.
/// @return root mean square residual after the adjustment [sigmas]. Infinite if an observed point
/// is not in front of its camera; the bundle is then unchanged.
double adjust(const PinholeCamera& camera, Bundle& bundle, const BundleOptions& options);

}  // namespace overfly::odometry
