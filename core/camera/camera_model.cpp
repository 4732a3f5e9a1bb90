#include "core/camera/camera_model.hpp"

#include <Eigen/LU>
#include <cmath>

namespace overfly {
namespace {

/// A radial function of the ideal radius r, as the factor s(r) = r_distorted / r and its slope.
struct Radial {
  double factor = 1.0;
  double d_factor_dr = 0.0;
};

Radial radtan_radial(const std::array<double, 5>& k, double r) {
  const double r2 = r * r;
  return {1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4])),
          r * (2.0 * k[0] + r2 * (4.0 * k[1] + r2 * 6.0 * k[4]))};
}

Radial equidistant_radial(const std::array<double, 5>& k, double r) {
  if (r < 1e-8) return {1.0, 0.0};
  const double theta = std::atan(r);
  const double t2 = theta * theta;
  const double theta_d = theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
  const double d_theta_d =
      1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])));
  const double d_dr = d_theta_d / (1.0 + r * r);
  return {theta_d / r, (d_dr - theta_d / r) / r};
}

Radial fov_radial(double w, double r) {
  if (std::abs(w) < 1e-9) return {1.0, 0.0};
  const double a = 2.0 * std::tan(0.5 * w);
  if (r < 1e-8) return {a / w, 0.0};
  const double r_d = std::atan(a * r) / w;
  const double d_dr = a / (w * (1.0 + a * a * r * r));
  return {r_d / r, (d_dr - r_d / r) / r};
}

Radial radial(const Distortion& distortion, double r) {
  switch (distortion.model) {
    case DistortionModel::kRadtan:
      return radtan_radial(distortion.k, r);
    case DistortionModel::kEquidistant:
      return equidistant_radial(distortion.k, r);
    case DistortionModel::kFov:
      return fov_radial(distortion.k[0], r);
    case DistortionModel::kNone:
      break;
  }
  return {};
}

/// d(r_distorted) / dr.
double radial_growth(const Distortion& distortion, double r) {
  const Radial at = radial(distortion, r);
  return at.factor + r * at.d_factor_dr;
}

/// The largest ideal radius up to which the distorted radius grows; infinity if it always does
/// (checked up to 88.9 deg from the axis).
double growth_limit(const Distortion& distortion) {
  constexpr double kFarthest = 50.0;
  constexpr int kSteps = 2000;
  const double theta_max = std::atan(kFarthest);
  for (int i = 1; i <= kSteps; ++i) {
    const double r = std::tan(theta_max * i / kSteps);
    if (!(radial_growth(distortion, r) > 0.0)) return std::tan(theta_max * (i - 1) / kSteps);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

const char* to_string(DistortionModel model) {
  switch (model) {
    case DistortionModel::kRadtan:
      return "radtan";
    case DistortionModel::kEquidistant:
      return "equidistant";
    case DistortionModel::kFov:
      return "fov";
    case DistortionModel::kNone:
      break;
  }
  return "none";
}

std::optional<DistortionModel> distortion_model_from(const std::string& text) {
  for (const DistortionModel model : {DistortionModel::kNone,
                                      DistortionModel::kRadtan,
                                      DistortionModel::kEquidistant,
                                      DistortionModel::kFov}) {
    if (text == to_string(model)) return model;
  }
  return std::nullopt;
}

int coefficient_count(DistortionModel model) {
  switch (model) {
    case DistortionModel::kRadtan:
      return 5;
    case DistortionModel::kEquidistant:
      return 4;
    case DistortionModel::kFov:
      return 1;
    case DistortionModel::kNone:
      break;
  }
  return 0;
}

CameraModel::CameraModel(const PinholeCamera& pinhole, const Distortion& distortion)
    : pinhole_(pinhole), distortion_(distortion) {
  if (!distortion_.none()) max_radius_ = growth_limit(distortion_);
}

Status CameraModel::validate() const {
  if (Status status = pinhole_.validate(); !status) return status;
  for (int i = 0; i < coefficient_count(distortion_.model); ++i) {
    const double value = distortion_.k[static_cast<std::size_t>(i)];
    if (!std::isfinite(value)) {
      return Error{ErrorCode::kInvalidArgument,
                   "distortion coefficient " + std::to_string(i) + " = " + std::to_string(value) +
                       ": must be finite"};
    }
  }
  if (distortion_.none()) return {};
  for (const double x_px : {-0.5, pinhole_.width_px - 0.5}) {
    for (const double y_px : {-0.5, pinhole_.height_px - 0.5}) {
      if (ray({x_px, y_px})) continue;
      return Error{ErrorCode::kInvalidArgument,
                   std::string("distortion ") + to_string(distortion_.model) +
                       ": folds the image before its corner (" + std::to_string(x_px) + ", " +
                       std::to_string(y_px) + ") px; the distorted radius must grow up to there"};
    }
  }
  return {};
}

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& ideal, Eigen::Matrix2d* J) const {
  const double r = ideal.norm();
  const Radial at = radial(distortion_, r);
  Eigen::Vector2d distorted = at.factor * ideal;
  if (J != nullptr) {
    *J = at.factor * Eigen::Matrix2d::Identity();
    if (r > 0.0) *J += (at.d_factor_dr / r) * ideal * ideal.transpose();
  }
  if (distortion_.model == DistortionModel::kRadtan) {
    const double x = ideal.x();
    const double y = ideal.y();
    const double p1 = distortion_.k[2];
    const double p2 = distortion_.k[3];
    distorted.x() += 2.0 * p1 * x * y + p2 * (3.0 * x * x + y * y);
    distorted.y() += p1 * (x * x + 3.0 * y * y) + 2.0 * p2 * x * y;
    if (J != nullptr) {
      (*J)(0, 0) += 2.0 * p1 * y + 6.0 * p2 * x;
      (*J)(0, 1) += 2.0 * p1 * x + 2.0 * p2 * y;
      (*J)(1, 0) += 2.0 * p1 * x + 2.0 * p2 * y;
      (*J)(1, 1) += 6.0 * p1 * y + 2.0 * p2 * x;
    }
  }
  return distorted;
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& p_camera) const {
  if (distortion_.none()) return pinhole_.project(p_camera);
  if (!(p_camera.z() > 0.0)) return std::nullopt;
  const Eigen::Vector2d ideal = p_camera.head<2>() / p_camera.z();
  // Beyond this radius the distortion would map a point back into the image.
  if (ideal.norm() > max_radius_) return std::nullopt;
  const Eigen::Vector2d distorted = distort(ideal, nullptr);
  return Eigen::Vector2d(pinhole_.fx_px * distorted.x() + pinhole_.cx_px,
                         pinhole_.fy_px * distorted.y() + pinhole_.cy_px);
}

std::optional<Eigen::Vector3d> CameraModel::ray(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector3d straight = pinhole_.ray(pixel);
  if (distortion_.none()) return straight;
  const Eigen::Vector2d wanted = straight.head<2>();
  constexpr double kFarthestIdeal = 50.0;
  // Start on the axis, so that Newton's method cannot cross the limit of growth.
  Eigen::Vector2d ideal = Eigen::Vector2d::Zero();
  constexpr int kIterations = 60;
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Matrix2d J;
    const Eigen::Vector2d residual = wanted - distort(ideal, &J);
    if (residual.norm() < 1e-13) break;
    if (!(std::abs(J.determinant()) > 1e-12)) return std::nullopt;
    Eigen::Vector2d step = J.inverse() * residual;
    const double longest = 0.5 * (1.0 + ideal.norm());
    if (step.norm() > longest) step *= longest / step.norm();
    ideal += step;
    if (!(ideal.norm() < kFarthestIdeal)) return std::nullopt;
  }
  if ((wanted - distort(ideal, nullptr)).norm() > 1e-10 || ideal.norm() > max_radius_) {
    return std::nullopt;
  }
  return Eigen::Vector3d(ideal.x(), ideal.y(), 1.0);
}

}  // namespace overfly
