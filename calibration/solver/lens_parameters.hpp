// A camera model as a vector of parameters: fx, fy, cx, cy [px] and the estimated coefficients of
// its distortion, in the model's order.
#pragma once

#include <Eigen/Core>

#include "core/camera/camera_model.hpp"

namespace overfly::calibration {

struct LensChoice {
  DistortionModel model = DistortionModel::kRadtan;  ///< kNone, kRadtan or kEquidistant
  /// Estimates k3 of radtan too; else it is 0. It describes strong distortion only, and DSO's,
  /// SVO's and Kalibr's files have no place for it.
  bool k3 = false;

  /// 0, 4 or 5.
  [[nodiscard]] int coefficients() const;
  /// Of the vector: 4 and the coefficients.
  [[nodiscard]] int parameters() const { return 4 + coefficients(); }
};

[[nodiscard]] Eigen::VectorXd parameters_of(const CameraModel& camera, const LensChoice& lens);
/// @param size  the image's size; its intrinsics are ignored
[[nodiscard]] CameraModel camera_of(const Eigen::VectorXd& parameters,
                                    const LensChoice& lens,
                                    const PinholeCamera& size);

/// A pixel and its derivatives.
struct ProjectedPoint {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> d_point;  ///< by the point in the camera frame [px/m]
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 9> d_parameters;
};

/// Projects a point as CameraModel::project, but also beyond the angle at which the distorted
/// radius stops growing, so that an optimiser may pass through such models.
/// @pre p_camera.z() > 0
[[nodiscard]] ProjectedPoint project_with_derivatives(const CameraModel& camera,
                                                      const LensChoice& lens,
                                                      const Eigen::Vector3d& p_camera);

}  // namespace overfly::calibration
