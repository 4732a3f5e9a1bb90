// A pinhole camera with lens distortion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <string>

#include "core/camera/camera.hpp"

namespace overfly {

enum class DistortionModel {
  kNone,
  kRadtan,       ///< k1 k2 p1 p2 k3 (Brown; OpenCV's order)
  kEquidistant,  ///< k1 k2 k3 k4 (Kannala, Brandt 2006, as OpenCV's fisheye)
  kFov,          ///< w [rad] (Devernay, Faugeras 2001; "ATAN" of SVO and PTAM)
};

/// "none", "radtan", "equidistant", "fov".
[[nodiscard]] const char* to_string(DistortionModel model);
[[nodiscard]] std::optional<DistortionModel> distortion_model_from(const std::string& text);
/// Number of coefficients of a model: 0, 5, 4, 1.
[[nodiscard]] int coefficient_count(DistortionModel model);

struct Distortion {
  DistortionModel model = DistortionModel::kNone;
  std::array<double, 5> k{};  ///< in the model's order; unused ones are 0

  [[nodiscard]] bool none() const { return model == DistortionModel::kNone; }
  bool operator==(const Distortion&) const = default;
};

/// Projection: pixel = K * distort(x / z, y / z). Immutable.
class CameraModel {
 public:
  CameraModel() = default;
  CameraModel(const PinholeCamera& pinhole, const Distortion& distortion = {});
  bool operator==(const CameraModel&) const = default;

  [[nodiscard]] const PinholeCamera& pinhole() const { return pinhole_; }  ///< size and K
  [[nodiscard]] const Distortion& distortion() const { return distortion_; }
  /// The ideal radius at which the distorted radius stops growing; infinity if it always grows.
  [[nodiscard]] double max_radius() const { return max_radius_; }

  /// Errors: kInvalidArgument naming the field: those of PinholeCamera::validate, a coefficient
  /// that is not finite, or a distortion that folds the image (the distorted radius must grow with
  /// the angle from the axis up to the image's farthest corner).
  [[nodiscard]] Status validate() const;

  /// Pixel of a point in the camera frame. Empty if the point is not in front of the camera
  /// (z <= 0) or lies beyond the angle at which the distorted radius stops growing.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera) const;
  /// Direction with z = 1 through a pixel, by Newton's method (to 1e-10 of the image plane). Empty
  /// if no direction in front of the camera maps to the pixel.
  [[nodiscard]] std::optional<Eigen::Vector3d> ray(const Eigen::Vector2d& pixel) const;
  /// Distorts a point (x / z, y / z) of the ideal image plane.
  /// @param J  receives the Jacobian; may be null
  [[nodiscard]] Eigen::Vector2d distort(const Eigen::Vector2d& ideal, Eigen::Matrix2d* J) const;

 private:
  PinholeCamera pinhole_;
  Distortion distortion_;
  double max_radius_ =
      std::numeric_limits<double>::infinity();  ///< ideal radius where growth stops
};

}  // namespace overfly
