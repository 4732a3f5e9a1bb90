// Defocus: convolves the image on the sensor with the lens's point spread.
#pragma once

#include "core/camera/image.hpp"

namespace overfly::sensor {

/// Convolves with a Gaussian of standard deviation sigma_px, sampled at whole pixels, truncated at
/// ceil(4 sigma) and scaled to sum 1; beyond the edge the edge's pixel is repeated.
/// @param sigma_px  > 0
[[nodiscard]] RadianceImage defocused(const RadianceImage& sharp, double sigma_px);

}  // namespace overfly::sensor
