// Points that an upstream system sees, made into depths, map points and debug images. C++11.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {

/// Middle one of the depths; 0 for none.
double median_depth(std::vector<double> depths);

/// A frame's grey pixels as an image to draw on.
RgbImage rgb_of(const AdapterFrame& frame, const AdapterCamera& camera);

/// Draws a square of 7 px around a pixel; what lies outside of the image is cut off.
void draw_square(RgbImage* image, double x_px, double y_px, const std::array<std::uint8_t, 3>& rgb);

/// Of unit quaternion x y z w from a rotation matrix, row by row (Shepperd 1978: divides by the
/// largest of the four components).
std::array<double, 4> quaternion_from(const std::array<double, 9>& R);

}  // namespace overfly_adapters
