// Inside terrain only: an image sampled at arbitrary places.
#pragma once

#include "terrain/imagery/imagery_raster.hpp"

namespace overfly::terrain {

/// Samples a raster at the places `pixels` (file pixel coordinates, corners at integers; row-major,
/// one column per texel; neighbours in the result are neighbours in the file).
///
/// Method: Catmull-Rom cubic convolution (Keys, 1981, 10.1109/TASSP.1981.1163711, a = -0.5) on the
/// pyramid level whose texels are at most as large as the result's, averaged over the result's
/// texel.
/// @param base_px  size of a texel of the result's level 0 along the file's axes [file pixels]; the
///                 same for all tiles, so that neighbours and levels agree
/// Errors: kIo; kCancelled.
[[nodiscard]] Result<Patch> resample(const ImageryRaster& raster,
                                     const Eigen::Matrix2Xd& pixels,
                                     const Eigen::Vector2d& base_px,
                                     int result_level,
                                     int width,
                                     int height,
                                     const Cancelled& cancelled = {});

}  // namespace overfly::terrain
