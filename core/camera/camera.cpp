#include "core/camera/camera.hpp"

#include <cmath>
#include <string>

#include "core/motion/pose.hpp"

namespace overfly {

Result<PinholeCamera> PinholeCamera::from_fov(int width_px,
                                              int height_px,
                                              double fov_rad,
                                              FovAxis axis) {
  if (!(fov_rad > 0.0 && fov_rad < kPi)) {
    return Error{
        ErrorCode::kInvalidArgument,
        "field of view = " + std::to_string(deg_from_rad(fov_rad)) + " deg: must be in (0, 180)"};
  }
  double extent_px = width_px;
  if (axis == FovAxis::kVertical) extent_px = height_px;
  if (axis == FovAxis::kDiagonal) extent_px = std::hypot(width_px, height_px);
  PinholeCamera camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fx_px = camera.fy_px = 0.5 * extent_px / std::tan(0.5 * fov_rad);
  camera.cx_px = 0.5 * (width_px - 1);
  camera.cy_px = 0.5 * (height_px - 1);
  if (Status status = camera.validate(); !status) return status.error();
  return camera;
}

Status PinholeCamera::validate() const {
  const auto bad = [](const char* field, double value, const char* limit) {
    return Error{ErrorCode::kInvalidArgument,
                 std::string(field) + " = " + std::to_string(value) + ": must be " + limit};
  };
  constexpr int kMaxSide = 16384;
  if (width_px < 1 || width_px > kMaxSide) return bad("width_px", width_px, "in [1, 16384]");
  if (height_px < 1 || height_px > kMaxSide) return bad("height_px", height_px, "in [1, 16384]");
  if (!(fx_px > 0.0) || !std::isfinite(fx_px)) return bad("fx_px", fx_px, "positive and finite");
  if (!(fy_px > 0.0) || !std::isfinite(fy_px)) return bad("fy_px", fy_px, "positive and finite");
  if (!std::isfinite(cx_px)) return bad("cx_px", cx_px, "finite");
  if (!std::isfinite(cy_px)) return bad("cy_px", cy_px, "finite");
  return {};
}

std::optional<Eigen::Vector2d> PinholeCamera::project(const Eigen::Vector3d& p_camera) const {
  if (!(p_camera.z() > 0.0)) return std::nullopt;
  return Eigen::Vector2d(fx_px * p_camera.x() / p_camera.z() + cx_px,
                         fy_px * p_camera.y() / p_camera.z() + cy_px);
}

Eigen::Vector3d PinholeCamera::ray(const Eigen::Vector2d& pixel) const {
  return {(pixel.x() - cx_px) / fx_px, (pixel.y() - cy_px) / fy_px, 1.0};
}

Eigen::Matrix3d PinholeCamera::K() const {
  Eigen::Matrix3d m;
  m << fx_px, 0, cx_px, 0, fy_px, cy_px, 0, 0, 1;
  return m;
}

}  // namespace overfly
