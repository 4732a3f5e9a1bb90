// Inside synthesis only: the files of a strip world.
#pragma once

#include <filesystem>
#include <functional>

#include "core/result.hpp"
#include "terrain/synthesis/landscape/landscape.hpp"
#include "terrain/synthesis/site.hpp"

namespace overfly::terrain::synthesis {

/// The sides of a strip are multiples of this number of texels, so that all overviews are exact.
inline constexpr int kStripStepPx = 1024;

struct Strip {
  Site site;
  double left_x_m = 0.0;  ///< of the imagery, in the site's CRS
  double top_y_m = 0.0;
  double texel_m = 0.5;
  int width_px = 0;   ///< along x, a multiple of kStripStepPx
  int height_px = 0;  ///< a multiple of kStripStepPx
};

/// A landscape of `swatch_px` texels a side (a multiple of kStripStepPx) with its mirror images to
/// the east, south and south-east, so that it repeats seamlessly. Errors: kIo, kCancelled.
[[nodiscard]] Status write_ground(const std::filesystem::path& file,
                                  const Landscape& land,
                                  const Strip& strip,
                                  int swatch_px,
                                  const std::function<bool(double)>& progress);

/// `imagery.vrt` over the ground file, and one file next to it for each overview. Errors: kIo.
[[nodiscard]] Status write_mosaic(const std::filesystem::path& folder,
                                  const std::filesystem::path& ground,
                                  const Strip& strip,
                                  int swatch_px);

/// Hills over the strip and 1 km around it. Errors: kIo, kCancelled.
[[nodiscard]] Status write_hills(const std::filesystem::path& file,
                                 const Strip& strip,
                                 double post_m,
                                 double relief_m,
                                 std::uint32_t seed,
                                 const std::function<bool(double)>& progress);

}  // namespace overfly::terrain::synthesis
