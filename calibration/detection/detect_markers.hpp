// Finds the markers of ChArUco boards in an image.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/camera/image.hpp"

namespace overfly::calibration {

struct FoundMarker {
  int id = 0;
  /// Outer corners of the dark border, from the printed marker's top left clockwise; to about a
  /// pixel.
  std::array<Eigen::Vector2d, 4> corners;
};

/// Finds dark quadrilaterals by adaptive thresholds, reads their cells through their homographies
/// and keeps those in the dictionary (the method of Garrido-Jurado et al. 2014, sections 4.1 and
/// 4.2). Each id occurs once, by increasing id.
/// @param image  8-bit grey
/// @param bits   4, 5 or 6
/// Throws cv::Exception.
[[nodiscard]] std::vector<FoundMarker> detect_markers(const Image& image, int bits);

}  // namespace overfly::calibration
