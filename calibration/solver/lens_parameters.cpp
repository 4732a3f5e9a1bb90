#include "calibration/solver/lens_parameters.hpp"

#include <cmath>

namespace overfly::calibration {
namespace {

using Derivatives = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 9>;

/// Of the distorted point by k1 k2 p1 p2 k3 (Brown 1966): the model is linear in them.
void radtan_derivatives(const Eigen::Vector2d& ideal, Derivatives& d) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = ideal.squaredNorm();
  d.col(4) = r2 * ideal;
  d.col(5) = r2 * r2 * ideal;
  d.col(6) = Eigen::Vector2d(2.0 * x * y, r2 + 2.0 * y * y);
  d.col(7) = Eigen::Vector2d(r2 + 2.0 * x * x, 2.0 * x * y);
  if (d.cols() > 8) d.col(8) = r2 * r2 * r2 * ideal;
}

/// Of the distorted point by k1 to k4 (Kannala, Brandt 2006, equation 6): linear too.
void equidistant_derivatives(const Eigen::Vector2d& ideal, Derivatives& d) {
  const double r = ideal.norm();
  const double theta = std::atan(r);
  const Eigen::Vector2d direction = r > 0.0 ? Eigen::Vector2d(ideal / r) : Eigen::Vector2d::Zero();
  double power = theta;
  for (int i = 4; i < d.cols(); ++i) {
    power *= theta * theta;
    d.col(i) = power * direction;
  }
}

}  // namespace

int LensChoice::coefficients() const {
  if (model == DistortionModel::kNone) return 0;
  return model == DistortionModel::kRadtan && k3 ? 5 : 4;
}

Eigen::VectorXd parameters_of(const CameraModel& camera, const LensChoice& lens) {
  Eigen::VectorXd parameters(lens.parameters());
  const PinholeCamera& c = camera.pinhole();
  parameters.head<4>() << c.fx_px, c.fy_px, c.cx_px, c.cy_px;
  for (int i = 0; i < lens.coefficients(); ++i) {
    parameters[4 + i] = camera.distortion().k[static_cast<std::size_t>(i)];
  }
  return parameters;
}

CameraModel camera_of(const Eigen::VectorXd& parameters,
                      const LensChoice& lens,
                      const PinholeCamera& size) {
  const PinholeCamera pinhole{
      size.width_px, size.height_px, parameters[0], parameters[1], parameters[2], parameters[3]};
  Distortion distortion;
  distortion.model = lens.model;
  for (int i = 0; i < lens.coefficients(); ++i) {
    distortion.k[static_cast<std::size_t>(i)] = parameters[4 + i];
  }
  return {pinhole, distortion};
}

ProjectedPoint project_with_derivatives(const CameraModel& camera,
                                        const LensChoice& lens,
                                        const Eigen::Vector3d& p_camera) {
  const double z = p_camera.z();
  const Eigen::Vector2d ideal = p_camera.head<2>() / z;
  Eigen::Matrix<double, 2, 3> d_ideal;
  d_ideal << 1.0 / z, 0.0, -ideal.x() / z, 0.0, 1.0 / z, -ideal.y() / z;
  Eigen::Matrix2d d_distorted;
  const Eigen::Vector2d distorted = camera.distort(ideal, &d_distorted);
  const PinholeCamera& c = camera.pinhole();
  const Eigen::Vector2d focal(c.fx_px, c.fy_px);

  ProjectedPoint projected;
  projected.pixel = focal.cwiseProduct(distorted) + Eigen::Vector2d(c.cx_px, c.cy_px);
  projected.d_point = focal.asDiagonal() * d_distorted * d_ideal;
  projected.d_parameters.resize(2, lens.parameters());
  projected.d_parameters.leftCols<4>() << distorted.x(), 0.0, 1.0, 0.0, 0.0, distorted.y(), 0.0,
      1.0;
  if (lens.model == DistortionModel::kRadtan) radtan_derivatives(ideal, projected.d_parameters);
  if (lens.model == DistortionModel::kEquidistant) {
    equidistant_derivatives(ideal, projected.d_parameters);
  }
  if (lens.coefficients() > 0) {
    projected.d_parameters.rightCols(lens.coefficients()) =
        focal.asDiagonal() * projected.d_parameters.rightCols(lens.coefficients()).eval();
  }
  return projected;
}

}  // namespace overfly::calibration
