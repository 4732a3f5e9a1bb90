#include "vo_bridges/adapters/scene_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace overfly_adapters {

double median_depth(std::vector<double> depths) {
  if (depths.empty()) return 0.0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

RgbImage rgb_of(const AdapterFrame& frame, const AdapterCamera& camera) {
  RgbImage image;
  image.width_px = camera.width_px;
  image.height_px = camera.height_px;
  const std::size_t count =
      static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  image.pixels.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) image.pixels[3 * i + k] = frame.pixels[i];
  }
  return image;
}

void draw_square(RgbImage* image,
                 double x_px,
                 double y_px,
                 const std::array<std::uint8_t, 3>& rgb) {
  if (!(x_px > -4.0 && y_px > -4.0 && x_px < image->width_px + 3 && y_px < image->height_px + 3)) {
    return;
  }
  const int centre_x = static_cast<int>(std::lround(x_px));
  const int centre_y = static_cast<int>(std::lround(y_px));
  for (int dy = -3; dy <= 3; ++dy) {
    for (int dx = -3; dx <= 3; ++dx) {
      const int x = centre_x + dx;
      const int y = centre_y + dy;
      const bool edge = std::abs(dx) == 3 || std::abs(dy) == 3;
      if (!edge || x < 0 || y < 0 || x >= image->width_px || y >= image->height_px) continue;
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image->width_px) +
          static_cast<std::size_t>(x);
      for (std::size_t k = 0; k < 3; ++k) image->pixels[3 * pixel + k] = rgb[k];
    }
  }
}

std::array<double, 4> quaternion_from(const std::array<double, 9>& R) {
  const double trace = R[0] + R[4] + R[8];
  // Four times the square of each component: 1 + 2 R_ii - trace for x, y, z; 1 + trace for w.
  const std::array<double, 4> squares = {
      {1.0 + 2.0 * R[0] - trace, 1.0 + 2.0 * R[4] - trace, 1.0 + 2.0 * R[8] - trace, 1.0 + trace}};
  const std::size_t largest =
      static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
  std::array<double, 4> q = {{0.0, 0.0, 0.0, 0.0}};
  const double twice = std::sqrt(squares[largest]);
  q[largest] = 0.5 * twice;
  const std::array<double, 3> differences = {{R[7] - R[5], R[2] - R[6], R[3] - R[1]}};
  if (largest == 3) {
    for (std::size_t k = 0; k < 3; ++k) q[k] = 0.5 * differences[k] / twice;
    return q;
  }
  const std::size_t second = (largest + 1) % 3;
  const std::size_t third = (largest + 2) % 3;
  q[3] = 0.5 * differences[largest] / twice;
  q[second] = 0.5 * (R[3 * largest + second] + R[3 * second + largest]) / twice;
  q[third] = 0.5 * (R[3 * largest + third] + R[3 * third + largest]) / twice;
  return q;
}

}  // namespace overfly_adapters
