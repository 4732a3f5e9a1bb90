// Inside terrain only: one imagery file as RGB texels with validity at every power of two.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "terrain/cancelled.hpp"
#include "terrain/raster/area_average.hpp"
#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/raster/georeference.hpp"
#include "terrain/raster/raster_bands.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// Level L's texel (i, j) is the area average of the file's texels
/// [i 2^L, (i + 1) 2^L) x [j 2^L, (j + 1) 2^L). Thread-safe after `open`.
class ImageryRaster {
 public:
  /// Opens the file and checks its bands and georeference.
  /// Errors: kNotFound, kUnreadable, kInvalidArgument, kCancelled naming the file.
  static Result<std::shared_ptr<ImageryRaster>> open(const ImageryLayer& layer,
                                                     const Cancelled& cancelled,
                                                     std::vector<std::string>& warnings);

  /// Values shown as 0 and 255, for bands that are not 8 bit; call before reading.
  void set_range(double low, double high) {
    bands_.low = low;
    bands_.high = high;
  }

  /// One-time preparation for reading: checks that the file's blocks lie inside it, and which of
  /// its overviews are area averages (others are not used). `read` calls it if needed. After a
  /// cancelled call the raster is unusable.
  /// Errors: kUnreadable; kCancelled.
  [[nodiscard]] Status prepare(const Cancelled& cancelled = {}) const;
  /// Warnings about a file that may be damaged, has a single colour, or must be read to a large
  /// part for distant views; call after `prepare`.
  [[nodiscard]] std::vector<std::string> doubts() const;

  /// Texels [x, x + width) x [y, y + height) of a level; void outside the file. The first read of a
  /// level that is coarser than every stored one reads the whole file.
  /// Errors: kIo with GDAL's reason; kCancelled.
  [[nodiscard]] Result<Patch> read(
      int level, int x, int y, int width, int height, const Cancelled& cancelled = {}) const;

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] const Georeference& georeference() const { return georeference_; }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] bool has_mask() const { return bands_.has_mask; }
  [[nodiscard]] const RasterBands& bands() const { return bands_; }
  [[nodiscard]] const std::string& format() const { return format_; }

 private:
  /// The file itself or one of its overviews.
  struct Stored {
    int level = 0;         ///< its power of two
    double ratio_x = 1.0;  ///< file texels per texel, not always exactly 2^level
    double ratio_y = 1.0;
    int width_px = 0;
    int height_px = 0;
    std::unique_ptr<DatasetPool> pool;

    [[nodiscard]] bool exact() const {
      return ratio_x == static_cast<double>(1 << level) && ratio_y == ratio_x;
    }
  };
  using Levels = std::vector<Patch>;
  /// Levels without a stored overview, computed on demand and kept while memory allows.
  struct Pyramid {
    std::once_flag prepared;
    Status state;
    std::vector<std::string> doubts;
    std::vector<Stored> stored;
    int first_level = 0;  ///< of `levels`: from where the stored ones are too fine
    std::mutex mutex;
    std::condition_variable made;
    bool making = false;  ///< some thread makes the levels
    std::weak_ptr<const Levels> levels;
  };

  [[nodiscard]] Status look_at_blocks(const Cancelled& cancelled) const;
  [[nodiscard]] Status look_for_a_picture(const std::vector<int>& rows_on_the_way,
                                          const Cancelled& cancelled) const;
  [[nodiscard]] Status add_overviews(GDALDataset& dataset, const Cancelled& cancelled) const;
  [[nodiscard]] Result<bool> overview_is_average(const Stored& finer,
                                                 const Stored& coarser,
                                                 const Cancelled& cancelled) const;
  [[nodiscard]] Result<Patch> read_stored(
      const Stored& stored, int x, int y, int width, int height) const;
  [[nodiscard]] Result<Patch> read_averaged(
      const Stored& stored, int level, int x, int y, int width, int height) const;
  [[nodiscard]] const Stored& source_for(int level) const;
  [[nodiscard]] Result<std::shared_ptr<const Levels>> coarse_levels(
      const Cancelled& cancelled) const;
  [[nodiscard]] Result<Levels> make_levels(const Cancelled& cancelled) const;

  std::filesystem::path file_;
  Georeference georeference_;
  RasterBands bands_;
  std::string format_;
  int width_px_ = 0;
  int height_px_ = 0;
  std::unique_ptr<Pyramid> pyramid_ = std::make_unique<Pyramid>();
};

}  // namespace overfly::terrain
