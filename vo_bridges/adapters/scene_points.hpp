// Converts points observed by an upstream system to depths, map points and debug images. C++11.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {

/// Median of the depths; 0 if there are none.
double median_depth(std::vector<double> depths);

/// Converts a frame's grey pixels to an RGB image, to draw on.
RgbImage rgb_of(const AdapterFrame& frame, const AdapterCamera& camera);

/// Draws a square of 7 px around a pixel, clipped at the image border.
void draw_square(RgbImage* image, double x_px, double y_px, const std::array<std::uint8_t, 3>& rgb);

/// Unit quaternion x y z w from a rotation matrix in row-major order (Shepperd 1978: divides by the
/// largest of the four components).
std::array<double, 4> quaternion_from(const std::array<double, 9>& R);

}  // namespace overfly_adapters
