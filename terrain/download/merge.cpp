#include "terrain/download/merge.hpp"

#include <cpl_string.h>

#include <algorithm>
#include <cmath>

#include "terrain/raster/georeference.hpp"

namespace overfly::terrain::download {
namespace fs = std::filesystem;

namespace {

Error gdal_failure(const fs::path& file, const GdalMessages& messages) {
  return {ErrorCode::kIo, file.string() + ": " + messages.text()};
}

Result<DatasetPtr> create(const ChunkLayer& layer, const fs::path& file) {
  GdalMessages messages;
  CPLStringList options;
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", "512");
  options.SetNameValue("BLOCKYSIZE", "512");
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("ZLEVEL", "6");
  options.SetNameValue("PREDICTOR", layer.heights ? "3" : "2");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  if (!layer.heights) options.SetNameValue("PHOTOMETRIC", "RGB");
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  DatasetPtr dataset(driver->Create(file.c_str(),
                                    layer.width_px,
                                    layer.height_px,
                                    layer.heights ? 1 : 3,
                                    layer.heights ? GDT_Float32 : GDT_Byte,
                                    options.List()));
  if (!dataset) return gdal_failure(file, messages);
  double g[6] = {layer.left, layer.pixel, 0.0, layer.top, 0.0, -layer.pixel};
  OGRSpatialReference crs;
  crs.SetFromUserInput(layer.crs.c_str());
  if (dataset->SetGeoTransform(g) != CE_None || dataset->SetSpatialRef(&crs) != CE_None) {
    return gdal_failure(file, messages);
  }
  if (layer.heights) {
    dataset->GetRasterBand(1)->SetNoDataValue(kNoHeight);
    dataset->GetRasterBand(1)->SetUnitType("m");
  }
  return dataset;
}

/// One chunk's pixels, band after band, and their validity.
struct Pixels {
  std::vector<std::uint8_t> rgb;
  std::vector<float> heights_m;
  std::vector<std::uint8_t> valid;  ///< 255 or 0
};

Status read_heights(GDALDataset& dataset, const Chunk& chunk, Pixels& pixels) {
  GdalMessages messages;
  const int width = chunk.width_px;
  const int height = chunk.height_px;
  pixels.heights_m.resize(pixels.valid.size());
  GDALRasterBand* band = dataset.GetRasterBand(1);
  if (band->RasterIO(GF_Read,
                     0,
                     0,
                     width,
                     height,
                     pixels.heights_m.data(),
                     width,
                     height,
                     GDT_Float32,
                     0,
                     0,
                     nullptr) != CE_None) {
    return gdal_failure(chunk.file, messages);
  }
  for (std::size_t i = 0; i < pixels.valid.size(); ++i) {
    float& value = pixels.heights_m[i];
    if (pixels.valid[i] == 0 || !(value > kLowestHeightM && value < kHighestHeightM)) {
      value = kNoHeight;
      pixels.valid[i] = 0;
    }
  }
  return {};
}

/// Converts palette indices to colours.
Status expand_palette(const GDALColorTable& table, std::size_t count, Pixels& pixels) {
  for (std::size_t i = 0; i < count; ++i) {
    GDALColorEntry entry{};
    table.GetColorEntryAsRGB(pixels.rgb[i], &entry);
    pixels.rgb[i] = static_cast<std::uint8_t>(entry.c1);
    pixels.rgb[count + i] = static_cast<std::uint8_t>(entry.c2);
    pixels.rgb[2 * count + i] = static_cast<std::uint8_t>(entry.c3);
    if (entry.c4 < 128) pixels.valid[i] = 0;
  }
  return {};
}

Status read_imagery(GDALDataset& dataset, const Chunk& chunk, Pixels& pixels) {
  GdalMessages messages;
  const int width = chunk.width_px;
  const int height = chunk.height_px;
  const std::size_t count = pixels.valid.size();
  pixels.rgb.resize(3 * count);
  const int bands = dataset.GetRasterCount();
  for (int c = 0; c < 3; ++c) {
    GDALRasterBand* band = dataset.GetRasterBand(bands >= 3 ? c + 1 : 1);
    if (band->RasterIO(GF_Read,
                       0,
                       0,
                       width,
                       height,
                       pixels.rgb.data() + c * count,
                       width,
                       height,
                       GDT_Byte,
                       0,
                       0,
                       nullptr) != CE_None) {
      return gdal_failure(chunk.file, messages);
    }
  }
  const GDALColorTable* table = dataset.GetRasterBand(1)->GetColorTable();
  if (table != nullptr) return expand_palette(*table, count, pixels);
  return {};
}

Result<Pixels> read(const ChunkLayer& layer, const Chunk& chunk) {
  Pixels pixels;
  const std::size_t count = static_cast<std::size_t>(chunk.width_px) * chunk.height_px;
  pixels.valid.assign(count, 255);
  auto dataset = open_raster(chunk.file);
  if (!dataset) return dataset.error();
  GdalMessages messages;
  GDALRasterBand* band = (*dataset)->GetRasterBand(1);
  if (band->GetMaskFlags() != GMF_ALL_VALID && band->GetMaskBand()->RasterIO(GF_Read,
                                                                             0,
                                                                             0,
                                                                             chunk.width_px,
                                                                             chunk.height_px,
                                                                             pixels.valid.data(),
                                                                             chunk.width_px,
                                                                             chunk.height_px,
                                                                             GDT_Byte,
                                                                             0,
                                                                             0,
                                                                             nullptr) != CE_None) {
    return gdal_failure(chunk.file, messages);
  }
  for (std::uint8_t& value : pixels.valid) value = value >= 128 ? 255 : 0;
  const Status done = layer.heights ? read_heights(**dataset, chunk, pixels)
                                    : read_imagery(**dataset, chunk, pixels);
  if (!done) return done.error();
  return pixels;
}

bool uniform(const Pixels& pixels) {
  const std::size_t count = pixels.valid.size();
  for (std::size_t c = 0; c < 3; ++c) {
    const auto begin = pixels.rgb.begin() + static_cast<std::ptrdiff_t>(c * count);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    if (std::adjacent_find(begin, end, std::not_equal_to<>()) != end) return false;
  }
  return true;
}

/// True if a chunk is absent or has its own mask.
bool may_have_voids(const ChunkLayer& layer) {
  return std::any_of(layer.chunks.begin(), layer.chunks.end(), [](const Chunk& chunk) {
    const auto dataset = open_raster(chunk.file);
    if (!dataset) return true;
    GDALRasterBand* band = (*dataset)->GetRasterBand(1);
    return band->GetMaskFlags() != GMF_ALL_VALID || band->GetColorTable() != nullptr;
  });
}

/// Writes one chunk's pixels, and its mask if the file has one.
Status write(GDALDataset& to, const ChunkLayer& layer, const Chunk& chunk, Pixels& pixels) {
  GdalMessages messages;
  const int x = chunk.column_px;
  const int y = chunk.row_px;
  const int width = chunk.width_px;
  const int height = chunk.height_px;
  CPLErr error = CE_None;
  if (layer.heights) {
    error = to.GetRasterBand(1)->RasterIO(GF_Write,
                                          x,
                                          y,
                                          width,
                                          height,
                                          pixels.heights_m.data(),
                                          width,
                                          height,
                                          GDT_Float32,
                                          0,
                                          0,
                                          nullptr);
  } else {
    for (int c = 0; c < 3 && error == CE_None; ++c) {
      error = to.GetRasterBand(c + 1)->RasterIO(GF_Write,
                                                x,
                                                y,
                                                width,
                                                height,
                                                pixels.rgb.data() + c * pixels.valid.size(),
                                                width,
                                                height,
                                                GDT_Byte,
                                                0,
                                                0,
                                                nullptr);
    }
    GDALRasterBand* mask = to.GetRasterBand(1)->GetMaskBand();
    if (error == CE_None && to.GetRasterBand(1)->GetMaskFlags() == GMF_PER_DATASET) {
      error = mask->RasterIO(GF_Write,
                             x,
                             y,
                             width,
                             height,
                             pixels.valid.data(),
                             width,
                             height,
                             GDT_Byte,
                             0,
                             0,
                             nullptr);
    }
  }
  if (error != CE_None)
    return Error{ErrorCode::kIo, "merging " + chunk.file.string() + ": " + messages.text()};
  return {};
}

int CPL_STDCALL overview_progress(double share, const char*, void* go_on) {
  return (*static_cast<const std::function<bool(double)>*>(go_on))(0.6 + 0.4 * share) ? TRUE
                                                                                      : FALSE;
}

Status add_overviews(GDALDataset& dataset,
                     const ChunkLayer& layer,
                     const fs::path& file,
                     const std::function<bool(double)>& go_on) {
  std::vector<int> factors;
  for (int f = 2; std::max(layer.width_px, layer.height_px) / f >= 256; f *= 2)
    factors.push_back(f);
  if (factors.empty()) return {};
  GdalMessages messages;
  const CPLErr built = dataset.BuildOverviews("AVERAGE",
                                              static_cast<int>(factors.size()),
                                              factors.data(),
                                              0,
                                              nullptr,
                                              &overview_progress,
                                              const_cast<std::function<bool(double)>*>(&go_on));
  if (built != CE_None) {
    if (!go_on(1.0)) return Error{ErrorCode::kCancelled, "the download was cancelled"};
    return gdal_failure(file, messages);
  }
  return {};
}

Result<MergeReport> fill(GDALDataset& to,
                         const ChunkLayer& layer,
                         const fs::path& file,
                         const std::function<bool(double)>& go_on) {
  MergeReport report;
  if (!layer.heights && may_have_voids(layer) && to.CreateMaskBand(GMF_PER_DATASET) != CE_None) {
    return Error{ErrorCode::kIo, file.string() + ": cannot hold a mask"};
  }
  std::size_t voids = 0;
  for (std::size_t i = 0; i < layer.chunks.size(); ++i) {
    if (!go_on(0.6 * static_cast<double>(i) / layer.chunks.size())) {
      return Error{ErrorCode::kCancelled, "the download was cancelled"};
    }
    const Chunk& chunk = layer.chunks[i];
    std::error_code ignored;
    Pixels pixels;
    const std::size_t count = static_cast<std::size_t>(chunk.width_px) * chunk.height_px;
    if (fs::exists(chunk.file, ignored)) {
      auto read_pixels = read(layer, chunk);
      if (!read_pixels) return read_pixels.error();
      pixels = std::move(*read_pixels);
      if (!layer.heights && uniform(pixels)) ++report.uniform_chunks;
    } else {
      pixels.valid.assign(count, 0);
      pixels.rgb.assign(layer.heights ? 0 : 3 * count, 0);
      pixels.heights_m.assign(layer.heights ? count : 0, kNoHeight);
    }
    voids += static_cast<std::size_t>(
        std::count(pixels.valid.begin(), pixels.valid.end(), std::uint8_t{0}));
    const Status written = write(to, layer, chunk, pixels);
    if (!written) return written.error();
  }
  report.void_share = static_cast<double>(voids) / layer.width_px / layer.height_px;
  return report;
}

}  // namespace

Result<MergeReport> merge_chunks(const ChunkLayer& layer,
                                 const fs::path& file,
                                 const std::function<bool(double)>& go_on) {
  initialise_gdal();
  const fs::path part = file.parent_path() / ("part_" + file.filename().string());
  const CPLConfigOptionSetter internal_mask("GDAL_TIFF_INTERNAL_MASK", "YES", false);
  Result<MergeReport> report = MergeReport{};
  {
    auto dataset = create(layer, part);
    if (!dataset) return dataset.error();
    report = fill(**dataset, layer, part, go_on);
    if (report) {
      const Status overviews = add_overviews(**dataset, layer, part, go_on);
      if (!overviews) report = overviews.error();
    }
    GdalMessages messages;
    (*dataset)->FlushCache(true);
    if (report && !messages.empty()) report = gdal_failure(part, messages);
  }
  std::error_code failed;
  if (!report) {
    fs::remove(part, failed);
    return report;
  }
  fs::rename(part, file, failed);
  if (failed) return Error{ErrorCode::kIo, file.string() + ": " + failed.message()};
  return report;
}

}  // namespace overfly::terrain::download
