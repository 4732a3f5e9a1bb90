#include "terrain/synthesis/world_files.hpp"

#include <cpl_conv.h>

#include <atomic>
#include <future>
#include <thread>

#include "terrain/area_average.hpp"
#include "terrain/gdal_dataset.hpp"
#include "terrain/synthesis/painter.hpp"

namespace overfly::terrain::synthesis {
namespace fs = std::filesystem;
namespace {

/// Side of the file's blocks, and of the blocks that are painted at once.
constexpr int kFileBlockPx = 256;
constexpr int kPaintBlockPx = 512;
constexpr int kOverviews = 5;
constexpr const char* kQuality = "90";

Error io_error(const fs::path& file, const GdalMessages& messages) {
  return {ErrorCode::kIo, file.string() + ": cannot be written: " + messages.text()};
}

/// Creation settings that only configuration options reach, for the time of one file.
class TiffSettings {
 public:
  TiffSettings() {
    for (const auto& [key, value] : kSettings) CPLSetThreadLocalConfigOption(key, value);
  }
  ~TiffSettings() {
    for (const auto& [key, value] : kSettings) CPLSetThreadLocalConfigOption(key, nullptr);
  }
  TiffSettings(const TiffSettings&) = delete;
  TiffSettings& operator=(const TiffSettings&) = delete;

 private:
  static constexpr std::pair<const char*, const char*> kSettings[] = {
      {"JPEG_QUALITY_OVERVIEW", kQuality},
      {"GDAL_TIFF_OVR_BLOCKSIZE", "256"},
      {"GDAL_PAM_ENABLED", "NO"}};
};

Status place(GDALDataset& dataset,
             const fs::path& file,
             const Site& site,
             double left,
             double top,
             double pixel) {
  const GdalMessages messages;
  double transform[6] = {left, pixel, 0.0, top, 0.0, -pixel};
  OGRSpatialReference crs;
  if (crs.importFromEPSG(site.epsg) != OGRERR_NONE ||
      dataset.SetGeoTransform(transform) != CE_None || dataset.SetSpatialRef(&crs) != CE_None) {
    return io_error(file, messages);
  }
  return {};
}

/// Paints a row of blocks on all processors.
Image paint_strip(const Landscape& land, float texel_m, int side_px, int y, int height) {
  Image strip(side_px, height, 3);
  const int blocks = (side_px + kPaintBlockPx - 1) / kPaintBlockPx;
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int block = next++; block < blocks; block = next++) {
      const int x = block * kPaintBlockPx;
      const int width = std::min(kPaintBlockPx, side_px - x);
      const Image painted = paint_block(land, texel_m, x, y, width, height);
      for (int row = 0; row < height; ++row) {
        std::copy_n(&painted.at(0, row), 3 * width, &strip.at(x, row));
      }
    }
  };
  std::vector<std::thread> helpers;
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  for (unsigned i = 1; i < processors; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  return strip;
}

/// Writes rows of one level, then their average into the next, from finest to coarsest.
class LevelWriter {
 public:
  LevelWriter(GDALDataset& dataset, int levels) : dataset_(dataset), levels_(levels) {}

  /// Rows must come in order. @return false when GDAL failed
  bool write(int level, int y, const Image& rows) {
    const bool overview = level > 0;
    for (int c = 0; c < 3; ++c) {
      GDALRasterBand* band = dataset_.GetRasterBand(c + 1);
      if (overview) band = band->GetOverview(level - 1);
      if (band == nullptr || band->RasterIO(GF_Write,
                                            0,
                                            y,
                                            rows.width_px,
                                            rows.height_px,
                                            const_cast<std::uint8_t*>(rows.data.data()) + c,
                                            rows.width_px,
                                            rows.height_px,
                                            GDT_Byte,
                                            3,
                                            GSpacing{3} * rows.width_px,
                                            nullptr) != CE_None) {
        return false;
      }
    }
    // Flushed here, blocks reach the file in one order whatever else fills GDAL's cache.
    for (int c = 0; c < 3; ++c) {
      GDALRasterBand* band = dataset_.GetRasterBand(c + 1);
      if (overview) band = band->GetOverview(level - 1);
      if (band->FlushCache(false) != CE_None) return false;
    }
    if (level + 1 >= levels_) return true;
    Patch patch{rows, Image(rows.width_px, rows.height_px, 1, 255)};
    const Patch half =
        area_average(patch, 0.0, 2.0, 0.0, 2.0, rows.width_px / 2, rows.height_px / 2);
    return write(level + 1, y / 2, half.rgb);
  }

 private:
  GDALDataset& dataset_;
  int levels_;
};

}  // namespace

Status write_imagery(const fs::path& file,
                     const Landscape& land,
                     const Site& site,
                     double texel_m,
                     int side_px,
                     const std::function<bool(double)>& progress) {
  initialise_gdal();
  const GdalMessages messages;
  const TiffSettings settings;
  CPLStringList options;
  options.SetNameValue("COMPRESS", "JPEG");
  options.SetNameValue("JPEG_QUALITY", kQuality);
  options.SetNameValue("PHOTOMETRIC", "YCBCR");
  options.SetNameValue("INTERLEAVE", "PIXEL");
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", std::to_string(kFileBlockPx).c_str());
  options.SetNameValue("BLOCKYSIZE", std::to_string(kFileBlockPx).c_str());
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  DatasetPtr dataset(driver->Create(file.c_str(), side_px, side_px, 3, GDT_Byte, options.List()));
  if (!dataset) return io_error(file, messages);
  const double half_m = 0.5 * side_px * texel_m;
  const Status placed =
      place(*dataset, file, site, site.middle_x_m - half_m, site.middle_y_m + half_m, texel_m);
  if (!placed) return placed.error();
  int factors[kOverviews] = {2, 4, 8, 16, 32};
  if (dataset->BuildOverviews("NONE", kOverviews, factors, 0, nullptr, nullptr, nullptr) !=
      CE_None) {
    return io_error(file, messages);
  }

  LevelWriter writer(*dataset, kOverviews + 1);
  std::future<bool> writing;
  for (int y = 0; y < side_px; y += kPaintBlockPx) {
    const int height = std::min(kPaintBlockPx, side_px - y);
    Image strip = paint_strip(land, static_cast<float>(texel_m), side_px, y, height);
    if (writing.valid() && !writing.get()) return io_error(file, messages);
    if (progress && !progress(static_cast<double>(y) / side_px)) {
      return Error{ErrorCode::kCancelled, "synthesis of " + file.string() + " was cancelled"};
    }
    writing = std::async(std::launch::async, [&writer, y, painted = std::move(strip)] {
      const TiffSettings own;
      return writer.write(0, y, painted);
    });
  }
  if (writing.valid() && !writing.get()) return io_error(file, messages);
  dataset.reset();
  return {};
}

Status write_heights(const fs::path& file, const Landscape& land, const Site& site) {
  initialise_gdal();
  const GdalMessages messages;
  const TiffSettings settings;
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "3");
  options.SetNameValue("TILED", "YES");
  const int side = land.relief.side_posts();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const DatasetPtr dataset(
      driver->Create(file.c_str(), side, side, 1, GDT_Float32, options.List()));
  if (!dataset) return io_error(file, messages);
  // Posts are pixel centres: the raster's corner lies half a post beyond the outermost.
  const double half_m = land.relief.half_m() + 0.5 * Relief::kPostM;
  const Status placed = place(
      *dataset, file, site, site.middle_x_m - half_m, site.middle_y_m + half_m, Relief::kPostM);
  if (!placed) return placed.error();
  std::vector<float> posts = land.relief.heights_m();
  for (float& height : posts) height += static_cast<float>(site.base_height_m);
  dataset->GetRasterBand(1)->SetUnitType("m");
  if (dataset->GetRasterBand(1)->RasterIO(
          GF_Write, 0, 0, side, side, posts.data(), side, side, GDT_Float32, 0, 0, nullptr) !=
      CE_None) {
    return io_error(file, messages);
  }
  return {};
}

}  // namespace overfly::terrain::synthesis
