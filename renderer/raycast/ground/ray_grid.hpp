// A camera's rays on a grid of nodes over the image.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "core/camera/camera_model.hpp"

namespace overfly::renderer::raycast {

inline constexpr int kCellPx = 16;  ///< side of a cell, if the lens permits
/// Limit of the error of bilinear interpolation of rays within a cell [px].
inline constexpr double kLensErrorPx = 0.02;

/// Cells of cell_px x cell_px pixels (fewer at the right and lower edge) and the rays at their
/// corners, which lie between the pixels: node (i, j) is at pixel (i * cell_px - 1/2, j * cell_px -
/// 1/2), or on the image's edge. Cells are halved until the interpolation error of a lens is below
/// kLensErrorPx; the rays of a camera without lens distortion are exact.
class RayGrid {
 public:
  explicit RayGrid(const CameraModel& camera);

  [[nodiscard]] bool is_of(const CameraModel& camera) const { return camera == camera_; }
  [[nodiscard]] int cell_px() const { return cell_px_; }
  [[nodiscard]] int columns() const { return columns_; }  ///< of cells
  [[nodiscard]] int rows() const { return rows_; }
  /// First pixel of a cell; for `columns()` and `rows()` the image's size.
  [[nodiscard]] int left_px(int column) const { return std::min(column * cell_px_, width_px_); }
  [[nodiscard]] int top_px(int row) const { return std::min(row * cell_px_, height_px_); }
  /// Direction with z = 1 at a node. Not finite where the lens has no ray.
  [[nodiscard]] const Eigen::Vector2d& ray(int column, int row) const {
    return rays_[static_cast<std::size_t>(row) * (columns_ + 1) + column];
  }
  /// Pixels per radian at the sharpest place of the image: the length in the image of a step
  /// parallel to the image plane, divided by the ratio of the step to its distance.
  [[nodiscard]] double px_per_rad() const { return px_per_rad_; }

 private:
  void lay_out(int cell_px);
  [[nodiscard]] double bend_px() const;

  CameraModel camera_;
  int width_px_, height_px_;
  int cell_px_ = kCellPx;
  int columns_ = 0, rows_ = 0;
  std::vector<Eigen::Vector2d> rays_;
  double px_per_rad_ = 1.0;
};

}  // namespace overfly::renderer::raycast
