// Inside terrain only: reduction of images by exact area averages, voids left out.
#pragma once

#include "terrain/tile_source.hpp"

namespace overfly::terrain {

/// Texels with their validity; like a tile, but of any size.
using Patch = Tile;

/// A patch of void texels.
[[nodiscard]] Patch void_patch(int width, int height);

/// Computes texel i of the result as the average of [first + i * step, first + (i + 1) * step) of
/// the source along each axis, in source texels from the source patch's corner; partly covered
/// texels are weighted by their covered fraction. A result texel is valid if at least half of its
/// area is.
/// @param step_x,  step_y  >= 1; equal integers with first = 0 use a fast exact path
[[nodiscard]] Patch area_average(const Patch& source,
                                 double first_x,
                                 double step_x,
                                 double first_y,
                                 double step_y,
                                 int width,
                                 int height);

}  // namespace overfly::terrain
