// Inside terrain only: the wavelet CDF(1,3) on blocks of 2 x 2 texels.
//
// A block of texels a b / c d has mean m and Haar details h = (b + d - a - c) / 4 (across), v = (c
// + d - a - b) / 4 (down), x = (a + d - b - c) / 4 (diagonal). A quadratic surface with the same
// means as the surrounding blocks predicts h as (east - west) / 8, v as (south - north) / 8 and x
// as the corners' (nw + se - ne - sw) / 64. CDF(1,3)'s details are the residuals. They are zero
// where the image is smooth, whatever its slope.
#pragma once

#include "core/camera/image.hpp"
#include "terrain/raster/area_average.hpp"

namespace overfly::terrain {

/// Luma of a patch (ITU-R BT.601 weights), void texels NaN.
[[nodiscard]] ImageBuffer<float> luma_of(const Patch& patch);

/// Means of the blocks of an image of even size; NaN where a texel of the block is NaN.
[[nodiscard]] ImageBuffer<float> block_means(const ImageBuffer<float>& image);

/// Details (h, v, x as channels) of an image's blocks; NaN if the block or one of its neighbours
/// has NaN, and along the rim.
/// @param means  block_means(image)
[[nodiscard]] ImageBuffer<float> block_details(const ImageBuffer<float>& image,
                                               const ImageBuffer<float>& means);

/// The local contrast at each texel of the image with these block details: the mean of (|h| + |v|)
/// / 2 over the surrounding 3 x 3 blocks, weighted by proximity; 0 if all are NaN. Twice the size
/// of `details`; the outermost four texels are not filled.
[[nodiscard]] ImageBuffer<float> local_contrast(const ImageBuffer<float>& details);

}  // namespace overfly::terrain
