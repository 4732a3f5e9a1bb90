#include "calibration/model_difference.hpp"

#include <algorithm>

namespace overfly::calibration {

ModelDifference model_difference(const CameraModel& camera, const CameraModel& other) {
  constexpr int kCols = 65;
  constexpr int kRows = 49;
  const Eigen::Vector2d step(static_cast<double>(camera.pinhole().width_px - 1) / (kCols - 1),
                             static_cast<double>(camera.pinhole().height_px - 1) / (kRows - 1));
  ModelDifference difference;
  double sum_px = 0.0;
  int count = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < kCols; ++col) {
      const Eigen::Vector2d pixel(col * step.x(), row * step.y());
      const auto ray = camera.ray(pixel);
      const auto again = ray ? other.project(*ray) : std::nullopt;
      if (!again) continue;
      const double distance_px = (*again - pixel).norm();
      difference.max_px = std::max(difference.max_px, distance_px);
      sum_px += distance_px;
      ++count;
    }
  }
  if (count > 0) difference.mean_px = sum_px / count;
  return difference;
}

}  // namespace overfly::calibration
