// Grey levels between pixels.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "core/camera/image.hpp"

namespace overfly::calibration {

/// Bilinear in the four pixels around a place; empty outside their centres.
[[nodiscard]] inline std::optional<double> grey_level(const Image& image,
                                                      const Eigen::Vector2d& pixel) {
  const double x = std::floor(pixel.x());
  const double y = std::floor(pixel.y());
  if (!(x >= 0.0 && y >= 0.0 && x + 1 < image.width_px && y + 1 < image.height_px)) {
    return std::nullopt;
  }
  const auto i = static_cast<int>(x);
  const auto j = static_cast<int>(y);
  const double u = pixel.x() - x;
  const double v = pixel.y() - y;
  return (1 - v) * ((1 - u) * image.at(i, j) + u * image.at(i + 1, j)) +
         v * ((1 - u) * image.at(i, j + 1) + u * image.at(i + 1, j + 1));
}

}  // namespace overfly::calibration
