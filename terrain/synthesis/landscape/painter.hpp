// Paints the landscape as seen vertically from above.
#pragma once

#include "core/camera/image.hpp"
#include "terrain/synthesis/landscape/landscape.hpp"

namespace overfly::terrain::synthesis {

/// Paints the texels [x, x + width) x [y, y + height) of an image of the landscape whose
/// north-west corner lies at (-half, +half). Any division into blocks gives the same texels.
/// Threads: pure.
[[nodiscard]] Image paint_block(
    const Landscape& land, float texel_m, int x, int y, int width, int height);

}  // namespace overfly::terrain::synthesis
