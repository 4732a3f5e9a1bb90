// Defocus: the image on the sensor folded with the lens's point spread.
#pragma once

#include "core/image.hpp"

namespace overfly::renderer {

/// Folds with a Gaussian of standard deviation sigma_px, sampled at whole pixels, cut at
/// ceil(4 sigma) and scaled to sum 1; beyond the edge the edge's pixel goes on.
/// @param sigma_px  > 0
[[nodiscard]] RadianceImage defocused(const RadianceImage& sharp, double sigma_px);

}  // namespace overfly::renderer
