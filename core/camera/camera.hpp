// The pinhole camera. Optical axes: x right, y down, z forward. Pixel centres at integers, so the
// image spans [-0.5, width - 0.5] x [-0.5, height - 0.5], and a centred principal point of a
// 1280 x 960 image is (639.5, 479.5).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/result.hpp"

namespace overfly {

/// The image axis along which a field of view is measured, edge to edge.
enum class FovAxis { kHorizontal, kVertical, kDiagonal };

struct PinholeCamera {
  int width_px = 1280;
  int height_px = 960;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;

  bool operator==(const PinholeCamera&) const = default;

  /// Square pixels, centred principal point. 84.872 deg over 1280 px gives f = 700.006 px.
  /// Errors: kInvalidArgument for a size below 1 px or a field of view outside (0, pi).
  static Result<PinholeCamera> from_fov(int width_px, int height_px, double fov_rad, FovAxis axis);

  /// Errors: kInvalidArgument naming the first field outside its limits.
  [[nodiscard]] Status validate() const;

  /// Pixel of a point in the camera frame; empty when the point is not in front (z <= 0).
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera) const;
  /// Direction with z = 1 through a pixel.
  [[nodiscard]] Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] Eigen::Matrix3d K() const;
};

}  // namespace overfly
