#include "renderer/raycast/ground/ray_grid.hpp"

#include <cmath>
#include <limits>

namespace overfly::renderer::raycast {

namespace {

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

Eigen::Vector2d ray_at(const CameraModel& camera, double x_px, double y_px) {
  const auto ray = camera.ray({x_px, y_px});
  return ray ? Eigen::Vector2d(ray->head<2>()) : Eigen::Vector2d(kNowhere, kNowhere);
}

}  // namespace

RayGrid::RayGrid(const CameraModel& camera)
    : camera_(camera),
      width_px_(camera.pinhole().width_px),
      height_px_(camera.pinhole().height_px) {
  lay_out(kCellPx);
  while (!camera_.distortion().none() && cell_px_ > 1 && bend_px() > kLensErrorPx) {
    lay_out(cell_px_ / 2);
  }
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Eigen::Vector2d& here = ray(column, row);
      const Eigen::Vector2d right = ray(column + 1, row) - here;
      const Eigen::Vector2d down = ray(column, row + 1) - here;
      if (!right.allFinite() || !down.allFinite()) continue;
      // A step parallel to the image plane, seen at a distance of 1, is smaller by the length of
      // the cell's longest ray.
      double squeeze = 1.0;
      for (int i = 0; i < 4; ++i) {
        const Eigen::Vector2d& corner = ray(column + (i & 1), row + (i >> 1));
        if (corner.allFinite()) squeeze = std::max(squeeze, 1.0 + corner.squaredNorm());
      }
      const double width = left_px(column + 1) - left_px(column);
      const double height = top_px(row + 1) - top_px(row);
      px_per_rad_ = std::max({px_per_rad_,
                              width * std::sqrt(squeeze) / right.norm(),
                              height * std::sqrt(squeeze) / down.norm()});
    }
  }
}

void RayGrid::lay_out(int cell_px) {
  cell_px_ = cell_px;
  columns_ = (width_px_ + cell_px - 1) / cell_px;
  rows_ = (height_px_ + cell_px - 1) / cell_px;
  rays_.clear();
  rays_.reserve(static_cast<std::size_t>(columns_ + 1) * (rows_ + 1));
  for (int row = 0; row <= rows_; ++row) {
    for (int column = 0; column <= columns_; ++column) {
      rays_.push_back(ray_at(camera_, left_px(column) - 0.5, top_px(row) - 0.5));
    }
  }
}

/// The largest distance between a cell's centre and the mean of its corners' rays [px], measured at
/// every fourth cell.
double RayGrid::bend_px() const {
  double worst_px = 0.0;
  for (int row = 0; row < rows_; row += 4) {
    for (int column = 0; column < columns_; column += 4) {
      const double x_px = 0.5 * (left_px(column) + left_px(column + 1) - 1);
      const double y_px = 0.5 * (top_px(row) + top_px(row + 1) - 1);
      const Eigen::Vector2d middle = 0.25 * (ray(column, row) + ray(column + 1, row) +
                                             ray(column, row + 1) + ray(column + 1, row + 1));
      if (!middle.allFinite()) continue;
      const auto seen = camera_.project({middle.x(), middle.y(), 1.0});
      if (seen) worst_px = std::max(worst_px, (*seen - Eigen::Vector2d(x_px, y_px)).norm());
    }
  }
  return worst_px;
}

}  // namespace overfly::renderer::raycast
