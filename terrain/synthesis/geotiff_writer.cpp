#include "terrain/synthesis/geotiff_writer.hpp"

#include <cpl_conv.h>

#include "terrain/raster/area_average.hpp"
#include "terrain/raster/georeference.hpp"

namespace overfly::terrain::synthesis {
namespace fs = std::filesystem;
namespace {

constexpr const char* kQuality = "90";
constexpr const char* kFileBlockPx = "256";
constexpr std::pair<const char*, const char*> kSettings[] = {{"JPEG_QUALITY_OVERVIEW", kQuality},
                                                             {"GDAL_TIFF_OVR_BLOCKSIZE", "256"},
                                                             {"GDAL_PAM_ENABLED", "NO"}};

}  // namespace

Error io_error(const fs::path& file, const GdalMessages& messages) {
  return {ErrorCode::kIo, file.string() + ": cannot be written: " + messages.text()};
}

TiffSettings::TiffSettings() {
  for (const auto& [key, value] : kSettings) CPLSetThreadLocalConfigOption(key, value);
}

TiffSettings::~TiffSettings() {
  for (const auto& [key, value] : kSettings) CPLSetThreadLocalConfigOption(key, nullptr);
}

Result<DatasetPtr> create_jpeg_tiff(const fs::path& file,
                                    int width_px,
                                    int height_px,
                                    int overviews) {
  initialise_gdal();
  const GdalMessages messages;
  CPLStringList options;
  options.SetNameValue("COMPRESS", "JPEG");
  options.SetNameValue("JPEG_QUALITY", kQuality);
  options.SetNameValue("PHOTOMETRIC", "YCBCR");
  options.SetNameValue("INTERLEAVE", "PIXEL");
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", kFileBlockPx);
  options.SetNameValue("BLOCKYSIZE", kFileBlockPx);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  DatasetPtr dataset(
      driver->Create(file.c_str(), width_px, height_px, 3, GDT_Byte, options.List()));
  if (!dataset) return io_error(file, messages);
  std::vector<int> factors;
  for (int i = 1; i <= overviews; ++i) factors.push_back(1 << i);
  if (dataset->BuildOverviews("NONE", overviews, factors.data(), 0, nullptr, nullptr, nullptr) !=
      CE_None) {
    return io_error(file, messages);
  }
  return dataset;
}

Result<DatasetPtr> create_height_tiff(const fs::path& file, int columns, int rows) {
  initialise_gdal();
  const GdalMessages messages;
  const TiffSettings settings;
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "3");
  options.SetNameValue("TILED", "YES");
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  DatasetPtr dataset(driver->Create(file.c_str(), columns, rows, 1, GDT_Float32, options.List()));
  if (!dataset) return io_error(file, messages);
  dataset->GetRasterBand(1)->SetUnitType("m");
  return dataset;
}

Status write_height_rows(GDALDataset& dataset,
                         const fs::path& file,
                         int row,
                         int rows,
                         const std::vector<float>& posts) {
  const GdalMessages messages;
  const int columns = dataset.GetRasterXSize();
  if (dataset.GetRasterBand(1)->RasterIO(GF_Write,
                                         0,
                                         row,
                                         columns,
                                         rows,
                                         const_cast<float*>(posts.data()),
                                         columns,
                                         rows,
                                         GDT_Float32,
                                         0,
                                         0,
                                         nullptr) != CE_None) {
    return io_error(file, messages);
  }
  return {};
}

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

bool LevelWriter::write(int level, int y, const Image& rows) {
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
  // Flushing here writes the blocks in a fixed order, independent of other use of GDAL's cache.
  for (int c = 0; c < 3; ++c) {
    GDALRasterBand* band = dataset_.GetRasterBand(c + 1);
    if (overview) band = band->GetOverview(level - 1);
    if (band->FlushCache(false) != CE_None) return false;
  }
  if (level + 1 >= levels_) return true;
  Patch patch{rows, Image(rows.width_px, rows.height_px, 1, 255)};
  const Patch half = area_average(patch, 0.0, 2.0, 0.0, 2.0, rows.width_px / 2, rows.height_px / 2);
  return write(level + 1, y / 2, half.rgb);
}

}  // namespace overfly::terrain::synthesis
