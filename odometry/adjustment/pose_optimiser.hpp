// Estimates the camera's pose from known points.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/motion/pose.hpp"

namespace overfly::odometry {

struct PoseObservation {
  Eigen::Vector3d point_vo = Eigen::Vector3d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 1.0;
};

struct PoseFitOptions {
  int rounds = 3;  ///< outliers are selected again in each round
  int iterations_per_round = 4;
  double huber = 2.0;    ///< residual from which the weight decreases [sigmas]
  double outlier = 6.0;  ///< residual from which an observation is ignored [sigmas]
};

struct PoseFit {
  Pose T_camera_vo;
  std::vector<std::uint8_t> inlier;  ///< one for each observation
  int inliers = 0;
  double rms_px = 0.0;  ///< over the inliers
};

/// Minimises the reprojection error over the pose only.
///
/// Method: Gauss-Newton on SE(3) with Huber weights and outlier selection between rounds, as in
/// motion-only bundle adjustment (Mur-Artal and Tardos 2017, section III-B, eq. 2,
/// DOI 10.1109/TRO.2017.2705103).
[[nodiscard]] PoseFit optimise_pose(const PinholeCamera& camera,
                                    const Pose& T_camera_vo_start,
                                    const std::vector<PoseObservation>& observations,
                                    const PoseFitOptions& options = {});

}  // namespace overfly::odometry
