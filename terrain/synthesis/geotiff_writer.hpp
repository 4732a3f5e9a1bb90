// Inside synthesis only: GeoTIFFs written row by row, with area-averaged overviews.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/camera/image.hpp"
#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/synthesis/site.hpp"

namespace overfly::terrain::synthesis {

[[nodiscard]] Error io_error(const std::filesystem::path& file, const GdalMessages& messages);

/// Sets creation options that exist only as configuration options, while one file is created.
class TiffSettings {
 public:
  TiffSettings();
  ~TiffSettings();
  TiffSettings(const TiffSettings&) = delete;
  TiffSettings& operator=(const TiffSettings&) = delete;
};

/// A tiled JPEG TIFF of RGB with `overviews` empty levels. Errors: kIo.
[[nodiscard]] Result<DatasetPtr> create_jpeg_tiff(const std::filesystem::path& file,
                                                  int width_px,
                                                  int height_px,
                                                  int overviews);

/// A tiled 32-bit float TIFF of heights in metres. Errors: kIo.
[[nodiscard]] Result<DatasetPtr> create_height_tiff(const std::filesystem::path& file,
                                                    int columns,
                                                    int rows);
/// Writes whole rows of posts from `row` on. Errors: kIo.
[[nodiscard]] Status write_height_rows(GDALDataset& dataset,
                                       const std::filesystem::path& file,
                                       int row,
                                       int rows,
                                       const std::vector<float>& posts);

/// Sets the georeference in the site's CRS. Errors: kIo.
[[nodiscard]] Status place(GDALDataset& dataset,
                           const std::filesystem::path& file,
                           const Site& site,
                           double left,
                           double top,
                           double pixel);

/// Writes rows of one level, then their average into the next, from finest to coarsest.
class LevelWriter {
 public:
  LevelWriter(GDALDataset& dataset, int levels) : dataset_(dataset), levels_(levels) {}

  /// Rows must come in order. @return false if GDAL failed
  bool write(int level, int y, const Image& rows);

 private:
  GDALDataset& dataset_;
  int levels_;
};

}  // namespace overfly::terrain::synthesis
