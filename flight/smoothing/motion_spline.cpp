#include "flight/smoothing/motion_spline.hpp"

#include <cmath>

namespace overfly::flight::smoothing {
namespace {

Eigen::Vector3d blended(const PositionSpline& spline,
                        std::size_t segment,
                        const Eigen::Vector4d& weights) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    sum += weights[static_cast<Eigen::Index>(i)] * spline.control_m[segment + i];
  }
  return sum;
}

}  // namespace

Eigen::Vector3d PositionSpline::position_m(double t_s) const {
  const SplineKnots::Place at = knots.place(t_s);
  return blended(*this, at.segment, spline_weights(at.u));
}

Eigen::Vector3d PositionSpline::velocity_m_s(double t_s) const {
  const SplineKnots::Place at = knots.place(t_s);
  return blended(*this, at.segment, spline_weights_1(at.u)) / knots.spacing_s;
}

Eigen::Vector3d PositionSpline::acceleration_m_s2(double t_s) const {
  const SplineKnots::Place at = knots.place(t_s);
  return blended(*this, at.segment, spline_weights_2(at.u)) / (knots.spacing_s * knots.spacing_s);
}

Eigen::Quaterniond rotation_from_vector(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  // sin(x / 2) / x, by its series near 0.
  const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond rotation;
  rotation.w() = std::cos(0.5 * angle);
  rotation.vec() = factor * v;
  return rotation.normalized();
}

Eigen::Vector3d vector_from_rotation(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector3d axis = sign * rotation.vec();
  const double sine = axis.norm();
  const double angle = 2.0 * std::atan2(sine, sign * rotation.w());
  return sine < 1e-9 ? Eigen::Vector3d(2.0 * axis) : Eigen::Vector3d(axis * (angle / sine));
}

Eigen::Quaterniond RotationSpline::rotation(double t_s) const {
  const SplineKnots::Place at = knots.place(t_s);
  const Eigen::Vector3d weights = cumulative_weights(at.u);
  Eigen::Quaterniond rotation = control[at.segment];
  for (std::size_t j = 0; j < 3; ++j) {
    const Eigen::Vector3d step =
        vector_from_rotation(control[at.segment + j].conjugate() * control[at.segment + j + 1]);
    rotation = rotation * rotation_from_vector(weights[static_cast<Eigen::Index>(j)] * step);
  }
  return rotation.normalized();
}

Eigen::Vector3d RotationSpline::angular_rate_rad_s(double t_s) const {
  const SplineKnots::Place at = knots.place(t_s);
  const Eigen::Vector3d weights = cumulative_weights(at.u);
  const Eigen::Vector3d rates = cumulative_weights_1(at.u) / knots.spacing_s;
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (std::size_t j = 0; j < 3; ++j) {
    const Eigen::Vector3d step =
        vector_from_rotation(control[at.segment + j].conjugate() * control[at.segment + j + 1]);
    const auto k = static_cast<Eigen::Index>(j);
    rate = rotation_from_vector(weights[k] * step).conjugate() * rate + rates[k] * step;
  }
  return rate;
}

}  // namespace overfly::flight::smoothing
