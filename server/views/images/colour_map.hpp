// Colours for images of a quantity: depth, and differences of grey levels.
#pragma once

#include <span>

#include "core/camera/image.hpp"
#include "server/views/picture_request.hpp"

namespace overfly::server {

/// A scale for depths: from the nearest to nearly the farthest, at round numbers, logarithmic if
/// the far end is more than eight times as far. Both ends are 0 if every pixel sees the sky.
[[nodiscard]] ColourScale depth_scale(const DepthImage& depth);

/// Near is bright yellow, far is dark blue, the sky grey. The ramp's lightness grows evenly (in
/// Oklab), so that it can be read without colour vision; web/src/views/colour_scale.ts has the
/// same colours.
[[nodiscard]] Image coloured_depth(const DepthImage& depth, const ColourScale& scale);

/// Differences a - b of the grey levels (luma of colour images), in [-255, 255].
/// @pre equal sizes
[[nodiscard]] ImageBuffer<std::int16_t> grey_difference(const Image& a, const Image& b);

/// A symmetric scale for differences: the power of two, at least 4, that nearly all are below.
[[nodiscard]] ColourScale difference_scale(const ImageBuffer<std::int16_t>& difference);

/// Blue is negative, orange positive, no difference nearly black.
[[nodiscard]] Image coloured_difference(const ImageBuffer<std::int16_t>& difference,
                                        const ColourScale& scale);

}  // namespace overfly::server
