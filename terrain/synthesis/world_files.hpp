// The painted landscape as the files of a world.
#pragma once

#include <filesystem>
#include <functional>

#include "core/result.hpp"
#include "terrain/synthesis/landscape/landscape.hpp"
#include "terrain/synthesis/site.hpp"

namespace overfly::terrain::synthesis {

/// Writes the imagery as a tiled JPEG GeoTIFF with its area-averaged overviews.
/// @param side_px  a multiple of 32
/// Errors: kIo, kCancelled.
[[nodiscard]] Status write_imagery(const std::filesystem::path& file,
                                   const Landscape& land,
                                   const Site& site,
                                   double texel_m,
                                   int side_px,
                                   const std::function<bool(double)>& progress);

/// Writes the heights as a 32-bit float GeoTIFF, metres above the ellipsoid.
[[nodiscard]] Status write_heights(const std::filesystem::path& file,
                                   const Landscape& land,
                                   const Site& site);

}  // namespace overfly::terrain::synthesis
