// A very long strip of land for endurance flights: small on disk, gigapixels through GDAL.
#pragma once

#include <cstdint>
#include <filesystem>

#include "terrain/synthesize.hpp"

namespace overfly::terrain {

struct StripOptions {
  std::uint64_t seed = 1;
  double length_m = 100e3;  ///< west to east, in [2000, 400000]
  double width_m = 4e3;     ///< in [1000, 20000]
  double texel_m = 0.5;     ///< imagery resolution, in [0.25, 5]
  double post_m = 5.0;      ///< elevation's spacing, in [2, 100]
  double relief_m = 60.0;   ///< height between valley and hilltop, in [0, 400]
};

/// Writes a world into `folder`, which must not exist or be empty (complete or not at all):
/// `ground.tif`, one painted landscape with its mirror images, which repeats seamlessly;
/// `imagery.vrt` repeats it along the strip, with area-averaged overviews; `elevation.tif` has
/// hills that do not repeat. Sides are rounded up to 1024 texels. The same options give the same
/// bytes.
/// Errors: kInvalidArgument naming the option, kConflict, kIo, kCancelled.
[[nodiscard]] Status synthesize_strip(const std::filesystem::path& folder,
                                      const StripOptions& options,
                                      const Progress& progress = {});

}  // namespace overfly::terrain
