// Inside terrain only: blocks of a TIFF that were never written ("sparse"). They read as zeros,
// which would appear as black imagery.
#pragma once

#include <gdal_priv.h>

#include "core/camera/image.hpp"
#include "terrain/cancelled.hpp"

namespace overfly::terrain {

/// Whether the band has such blocks; examines the file's table of blocks and reads none of them.
/// Errors: kCancelled naming `file`.
[[nodiscard]] Result<bool> has_unwritten_blocks(GDALRasterBand& band,
                                                const std::filesystem::path& file,
                                                const Cancelled& cancelled);

/// Sets `valid`, the window whose first texel is (x, y), to 0 where the band has such blocks.
void mask_unwritten_blocks(GDALRasterBand& band, int x, int y, Image& valid);

}  // namespace overfly::terrain
