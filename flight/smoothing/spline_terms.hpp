// Terms of the sums that the splines' fits minimise. Private to the fits.
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "flight/smoothing/spline_knots.hpp"

namespace overfly::flight::smoothing {

/// Linear in four control points: scale .* (sum of weights * control points - target).
class LinearTerm final : public ceres::SizedCostFunction<3, 3, 3, 3, 3> {
 public:
  LinearTerm(const Eigen::Vector4d& weights,
             const Eigen::Vector3d& scale,
             const Eigen::Vector3d& target)
      : weights_(weights), scale_(scale), target_(target) {}

  bool Evaluate(double const* const* controls,
                double* residuals,
                double** jacobians) const override {
    Eigen::Vector3d sum = -target_;
    for (int i = 0; i < 4; ++i) {
      sum += weights_[i] * Eigen::Map<const Eigen::Vector3d>(controls[i]);
    }
    Eigen::Map<Eigen::Vector3d>{residuals} = scale_.cwiseProduct(sum);
    if (jacobians == nullptr) return true;
    for (int i = 0; i < 4; ++i) {
      if (jacobians[i] == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{jacobians[i]} =
          (weights_[i] * scale_).asDiagonal();
    }
    return true;
  }

 private:
  Eigen::Vector4d weights_;
  Eigen::Vector3d scale_;
  Eigen::Vector3d target_;
};

/// As motion_spline.hpp, also for automatic derivatives.
template <typename T>
Eigen::Quaternion<T> rotation_from(const Eigen::Matrix<T, 3, 1>& v) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T square = v.squaredNorm();
  if (square < T(1e-16)) {
    return Eigen::Quaternion<T>(T(1.0), T(0.5) * v[0], T(0.5) * v[1], T(0.5) * v[2]);
  }
  const T angle = sqrt(square);
  const T factor = sin(T(0.5) * angle) / angle;
  return Eigen::Quaternion<T>(cos(T(0.5) * angle), factor * v[0], factor * v[1], factor * v[2]);
}

template <typename T>
Eigen::Matrix<T, 3, 1> vector_of(const Eigen::Quaternion<T>& rotation) {
  using std::atan2;
  using std::sqrt;
  const T sign = rotation.w() < T(0.0) ? T(-1.0) : T(1.0);
  const Eigen::Matrix<T, 3, 1> axis = sign * rotation.vec();
  const T square = axis.squaredNorm();
  if (square < T(1e-16)) return T(2.0) * axis;
  const T sine = sqrt(square);
  return (T(2.0) * atan2(sine, sign * rotation.w()) / sine) * axis;
}

/// The rotation vector from the spline to a sample, over its standard deviation. Control points are
/// quaternions x, y, z, w.
struct RotationTerm {
  Eigen::Vector3d weights;  ///< cumulative
  Eigen::Quaterniond sample;
  double scale = 1.0;

  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, const T* d, T* residuals) const {
    using Rotation = Eigen::Quaternion<T>;
    const Eigen::Map<const Rotation> controls[] = {Eigen::Map<const Rotation>(a),
                                                   Eigen::Map<const Rotation>(b),
                                                   Eigen::Map<const Rotation>(c),
                                                   Eigen::Map<const Rotation>(d)};
    Rotation rotation = controls[0];
    for (int j = 0; j < 3; ++j) {
      const Rotation step = controls[j].conjugate() * controls[j + 1];
      const Eigen::Matrix<T, 3, 1> turn = T(weights[j]) * vector_of(step);
      rotation = rotation * rotation_from(turn);
    }
    const Rotation error = rotation.conjugate() * sample.cast<T>();
    Eigen::Map<Eigen::Matrix<T, 3, 1>>{residuals} = T(scale) * vector_of(error);
    return true;
  }
};

/// The change of the step from one control point to the next, scaled.
struct AngularAccelerationTerm {
  double scale = 1.0;

  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, T* residuals) const {
    using Rotation = Eigen::Quaternion<T>;
    const Eigen::Map<const Rotation> first(a);
    const Eigen::Map<const Rotation> second(b);
    const Eigen::Map<const Rotation> third(c);
    const Rotation before = first.conjugate() * second;
    const Rotation after = second.conjugate() * third;
    const Eigen::Matrix<T, 3, 1> change = vector_of(after) - vector_of(before);
    Eigen::Map<Eigen::Matrix<T, 3, 1>>{residuals} = T(scale) * change;
    return true;
  }
};

}  // namespace overfly::flight::smoothing
