// Small GeoTIFF worlds for tests, made in well under a second.
#pragma once

#include <filesystem>
#include <string>

#include "core/camera/image.hpp"
#include "terrain/world.hpp"

namespace overfly::testing {

/// An image with a place on the earth.
struct GeoTiff {
  Image image;  ///< grey or RGB
  std::string crs = "EPSG:32616";
  /// CRS coordinates of the north-west corner of the north-west pixel, and the pixel's size, in
  /// the CRS's own units (metres, feet, degrees).
  double left = 0.0;
  double top = 0.0;
  double pixel = 1.0;
  /// Tie the georeference to the middle of the corner pixel (PixelIsPoint): same place, other tags.
  bool pixel_is_point = false;
  Image valid;        ///< 0 = void; empty = all valid
  bool jpeg = false;  ///< lossy, tiled, as orthophotos come
  int overviews = 0;  ///< levels of area averages stored in the file
};

/// Writes it. Throws std::runtime_error with GDAL's reason.
void write_geotiff(const std::filesystem::path& file, const GeoTiff& tiff);

/// Heights as a 32-bit float GeoTIFF; posts are pixel centres. NaN posts become nodata.
void write_elevation(const std::filesystem::path& file,
                     const ImageBuffer<float>& heights_m,
                     const std::string& crs,
                     double left,
                     double top,
                     double pixel);

/// A picture with detail at every scale that only its place and seed decide.
[[nodiscard]] Image textured_image(int width_px, int height_px, int channels, unsigned seed = 1);

/// Alternating squares of `square_px` pixels, the north-west one dark.
[[nodiscard]] Image checkerboard_image(int width_px, int height_px, int square_px);

struct SyntheticWorldOptions {
  double size_m = 600.0;
  double texel_m = 0.5;
  double lat_deg = 39.35;  ///< of the middle
  double lon_deg = -86.03;
  double ground_m = 200.0;  ///< ellipsoidal height of the middle
  double relief_m = 20.0;   ///< smooth hills; 0 = flat posts
  unsigned seed = 1;
};

/// Textured imagery with hills in UTM: files in `folder`, the spec that opens them.
[[nodiscard]] terrain::WorldSpec write_synthetic_world(const std::filesystem::path& folder,
                                                       const SyntheticWorldOptions& options = {});

}  // namespace overfly::testing
