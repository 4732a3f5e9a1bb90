#include "terrain/raster/raster_bands.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "terrain/raster/unwritten_blocks.hpp"

namespace overfly::terrain {
namespace {

int band_of(GDALDataset& dataset, GDALColorInterp wanted) {
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    if (dataset.GetRasterBand(i)->GetColorInterpretation() == wanted) return i;
  }
  return 0;
}

bool has_mask(GDALDataset& dataset, const RasterBands& bands) {
  return std::any_of(bands.rgb.begin(), bands.rgb.end(), [&](int band) {
    return (dataset.GetRasterBand(band)->GetMaskFlags() & GMF_ALL_VALID) == 0;
  });
}

/// GDAL's progress callback, called between rows: whether reading continues.
int CPL_STDCALL ask(double, const char*, void* cancelled) {
  const auto& asked = *static_cast<const Cancelled*>(cancelled);
  return asked && asked() ? FALSE : TRUE;
}

/// Adds a sample of one band's values, without those that mark voids.
Status add_sample(GDALDataset& dataset,
                  int band_number,
                  const std::string& file,
                  const std::optional<double>& void_value,
                  const Cancelled& cancelled,
                  std::vector<float>& all) {
  constexpr int kSample = 256;
  const int width = std::min(kSample, dataset.GetRasterXSize());
  const int height = std::min(kSample, dataset.GetRasterYSize());
  std::vector<float> sample(static_cast<std::size_t>(width) * height);
  const GdalMessages messages;
  GDALRasterIOExtraArg questions;
  INIT_RASTERIO_EXTRA_ARG(questions);
  questions.pfnProgress = &ask;
  questions.pProgressData = const_cast<Cancelled*>(&cancelled);
  GDALRasterBand* band = dataset.GetRasterBand(band_number);
  if (band->RasterIO(GF_Read,
                     0,
                     0,
                     band->GetXSize(),
                     band->GetYSize(),
                     sample.data(),
                     width,
                     height,
                     GDT_Float32,
                     0,
                     0,
                     &questions) != CE_None) {
    if (Status status = go_on(cancelled, file); !status) return status;
    return Error{ErrorCode::kUnreadable, file + ": cannot be read: " + messages.text()};
  }
  int has_nodata = 0;
  auto nodata = static_cast<float>(band->GetNoDataValue(&has_nodata));
  if (void_value) {
    has_nodata = 1;
    nodata = static_cast<float>(*void_value);
  }
  std::copy_if(sample.begin(), sample.end(), std::back_inserter(all), [&](float v) {
    return std::isfinite(v) && (has_nodata == 0 || v != nodata);
  });
  return {};
}

/// Chooses one range for all bands, so that colours keep their hue: 0.5 % to 99.5 % of a sample.
Status find_range(GDALDataset& dataset,
                  const std::string& file,
                  const Cancelled& cancelled,
                  RasterBands& bands) {
  std::vector<float> sample;
  for (int c = 0; c < 3; ++c) {
    if (c > 0 && bands.rgb[c] == bands.rgb[0]) break;
    Status added = add_sample(dataset, bands.rgb[c], file, bands.nodata, cancelled, sample);
    if (!added) return added;
  }
  bands.low = std::numeric_limits<double>::infinity();
  bands.high = -bands.low;
  if (sample.empty()) return {};
  std::sort(sample.begin(), sample.end());
  bands.low = sample[static_cast<std::size_t>(0.005 * static_cast<double>(sample.size() - 1))];
  bands.high = sample[static_cast<std::size_t>(0.995 * static_cast<double>(sample.size() - 1))];
  return {};
}

void read_palette(GDALDataset& dataset, RasterBands& bands) {
  const GDALColorTable* table = dataset.GetRasterBand(1)->GetColorTable();
  if (table == nullptr) return;
  bands.palette = true;
  bands.colours.assign(256, {0, 0, 0, 255});
  for (int i = 0; i < std::min(256, table->GetColorEntryCount()); ++i) {
    GDALColorEntry entry;
    table->GetColorEntryAsRGB(i, &entry);
    for (int c = 0; c < 4; ++c) {
      const short value = c == 0 ? entry.c1 : c == 1 ? entry.c2 : c == 2 ? entry.c3 : entry.c4;
      bands.colours[i][c] = static_cast<std::uint8_t>(std::clamp<int>(value, 0, 255));
    }
    if (bands.colours[i][3] < 128) bands.has_mask = true;
  }
}

CPLErr read_bytes(GDALDataset& dataset, const RasterBands& bands, int x, int y, Image& rgb) {
  std::array<int, 3> numbers = bands.rgb;
  const bool grey = numbers[0] == numbers[1];
  const int width = rgb.width_px;
  const int height = rgb.height_px;
  const CPLErr outcome = dataset.RasterIO(GF_Read,
                                          x,
                                          y,
                                          width,
                                          height,
                                          rgb.data.data(),
                                          width,
                                          height,
                                          GDT_Byte,
                                          grey ? 1 : 3,
                                          numbers.data(),
                                          3,
                                          GSpacing{3} * width,
                                          1,
                                          nullptr);
  if (!grey || outcome != CE_None) return outcome;
  for (std::size_t i = 0; i < rgb.data.size(); i += 3) {
    const std::uint8_t value = rgb.data[i];
    for (int c = 0; c < 3; ++c) {
      rgb.data[i + c] = bands.palette ? bands.colours[value][c] : value;
    }
  }
  return outcome;
}

CPLErr read_rescaled(GDALDataset& dataset, const RasterBands& bands, int x, int y, Image& rgb) {
  const int width = rgb.width_px;
  const int height = rgb.height_px;
  std::vector<float> values(static_cast<std::size_t>(width) * height);
  for (int c = 0; c < 3; ++c) {
    const CPLErr outcome = dataset.GetRasterBand(bands.rgb[c])
                               ->RasterIO(GF_Read,
                                          x,
                                          y,
                                          width,
                                          height,
                                          values.data(),
                                          width,
                                          height,
                                          GDT_Float32,
                                          0,
                                          0,
                                          nullptr);
    if (outcome != CE_None) return outcome;
    const double factor = 255.0 / (bands.high - bands.low);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double scaled = std::clamp((values[i] - bands.low) * factor, 0.0, 255.0);
      rgb.data[3 * i + c] = static_cast<std::uint8_t>(std::lround(scaled));
    }
  }
  return CE_None;
}

/// A texel is void if every colour band has the manifest's value.
CPLErr read_nodata(GDALDataset& dataset, const RasterBands& bands, int x, int y, Image& valid) {
  std::vector<float> values(valid.data.size());
  std::vector<std::uint8_t> differs(valid.data.size(), 0);
  const auto nodata = static_cast<float>(*bands.nodata);
  for (int c = 0; c < 3; ++c) {
    if (c > 0 && bands.rgb[c] == bands.rgb[0]) break;
    const CPLErr outcome = dataset.GetRasterBand(bands.rgb[c])
                               ->RasterIO(GF_Read,
                                          x,
                                          y,
                                          valid.width_px,
                                          valid.height_px,
                                          values.data(),
                                          valid.width_px,
                                          valid.height_px,
                                          GDT_Float32,
                                          0,
                                          0,
                                          nullptr);
    if (outcome != CE_None) return outcome;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] != nodata) differs[i] = 1;
    }
  }
  for (std::size_t i = 0; i < differs.size(); ++i) {
    if (differs[i] == 0) valid.data[i] = 0;
  }
  return CE_None;
}

/// A texel is void if every colour band says so (nodata 0 must not mask a dark red).
CPLErr read_mask(GDALDataset& dataset, const RasterBands& bands, int x, int y, Image& valid) {
  if (bands.nodata) return read_nodata(dataset, bands, x, y, valid);
  std::fill(valid.data.begin(), valid.data.end(), std::uint8_t{0});
  Image one(valid.width_px, valid.height_px, 1);
  for (int c = 0; c < 3; ++c) {
    if (c > 0 && bands.rgb[c] == bands.rgb[0]) break;
    GDALRasterBand* band = dataset.GetRasterBand(bands.rgb[c]);
    const int flags = band->GetMaskFlags();
    const CPLErr outcome = band->GetMaskBand()->RasterIO(GF_Read,
                                                         x,
                                                         y,
                                                         valid.width_px,
                                                         valid.height_px,
                                                         one.data.data(),
                                                         valid.width_px,
                                                         valid.height_px,
                                                         GDT_Byte,
                                                         0,
                                                         0,
                                                         nullptr);
    if (outcome != CE_None) return outcome;
    for (std::size_t i = 0; i < one.data.size(); ++i) {
      if (one.data[i] >= 128) valid.data[i] = 255;
    }
    if ((flags & (GMF_PER_DATASET | GMF_ALPHA)) != 0) break;
  }
  return CE_None;
}

void mask_palette(GDALDataset& dataset, const RasterBands& bands, int x, int y, Image& valid) {
  Image index(valid.width_px, valid.height_px, 1);
  if (dataset.GetRasterBand(1)->RasterIO(GF_Read,
                                         x,
                                         y,
                                         index.width_px,
                                         index.height_px,
                                         index.data.data(),
                                         index.width_px,
                                         index.height_px,
                                         GDT_Byte,
                                         0,
                                         0,
                                         nullptr) != CE_None) {
    return;
  }
  for (std::size_t i = 0; i < index.data.size(); ++i) {
    if (bands.colours[index.data[i]][3] < 128) valid.data[i] = 0;
  }
}

/// A texel is void if it was written in none of the colour bands.
void mask_unwritten(GDALDataset& dataset, const RasterBands& bands, int x, int y, Image& valid) {
  Image written(valid.width_px, valid.height_px, 1);
  Image one(valid.width_px, valid.height_px, 1);
  for (int c = 0; c < 3; ++c) {
    if (c > 0 && bands.rgb[c] == bands.rgb[0]) break;
    std::fill(one.data.begin(), one.data.end(), std::uint8_t{255});
    mask_unwritten_blocks(*dataset.GetRasterBand(bands.rgb[c]), x, y, one);
    for (std::size_t i = 0; i < one.data.size(); ++i) written.data[i] |= one.data[i];
  }
  for (std::size_t i = 0; i < written.data.size(); ++i) valid.data[i] &= written.data[i];
}

void paint_voids(Patch& patch) {
  for (std::size_t i = 0; i < patch.valid.data.size(); ++i) {
    if (patch.valid.data[i] != 0) continue;
    for (int c = 0; c < 3; ++c) patch.rgb.data[3 * i + c] = kVoidRgb[c];
  }
}

}  // namespace

Result<RasterBands> find_bands(GDALDataset& dataset,
                               const std::string& file,
                               const std::optional<double>& nodata,
                               const std::optional<std::array<double, 2>>& range,
                               const Cancelled& cancelled) {
  RasterBands bands;
  bands.nodata = nodata;
  const int count = dataset.GetRasterCount();
  if (const int red = band_of(dataset, GCI_RedBand); red > 0) {
    const int green = band_of(dataset, GCI_GreenBand);
    const int blue = band_of(dataset, GCI_BlueBand);
    if (green > 0 && blue > 0) bands.rgb = {red, green, blue};
  } else if (count >= 3) {
    bands.rgb = {1, 2, 3};
  }
  if (bands.rgb[0] == bands.rgb[1]) read_palette(dataset, bands);
  bands.type = dataset.GetRasterBand(bands.rgb[0])->GetRasterDataType();
  if (GDALDataTypeIsComplex(bands.type) != 0) {
    return Error{ErrorCode::kUnreadable, file + ": has complex samples, not an image"};
  }
  bands.rescaled = bands.type != GDT_Byte;
  if (range && !bands.rescaled) {
    return Error{ErrorCode::kInvalidArgument,
                 file + ": samples are 8 bit, which \"range\" does not apply to"};
  }
  if (range) {
    bands.low = (*range)[0];
    bands.high = (*range)[1];
  } else if (bands.rescaled) {
    const Status found = find_range(dataset, file, cancelled, bands);
    if (!found) return found.error();
  }
  for (int c = 0; c < 3 && !bands.unwritten; ++c) {
    if (c > 0 && bands.rgb[c] == bands.rgb[0]) break;
    const auto found = has_unwritten_blocks(*dataset.GetRasterBand(bands.rgb[c]), file, cancelled);
    if (!found) return found.error();
    bands.unwritten = *found;
  }
  bands.has_mask = bands.has_mask || bands.nodata || bands.unwritten || has_mask(dataset, bands);
  return bands;
}

Result<Patch> read_bands(GDALDataset& dataset,
                         const RasterBands& bands,
                         const std::string& file,
                         int x,
                         int y,
                         int width,
                         int height) {
  const GdalMessages messages;
  Patch patch{Image(width, height, 3), Image(width, height, 1, 255)};
  CPLErr outcome = bands.rescaled ? read_rescaled(dataset, bands, x, y, patch.rgb)
                                  : read_bytes(dataset, bands, x, y, patch.rgb);
  if (outcome == CE_None && bands.has_mask) {
    outcome = read_mask(dataset, bands, x, y, patch.valid);
    if (bands.palette) mask_palette(dataset, bands, x, y, patch.valid);
    if (bands.unwritten) mask_unwritten(dataset, bands, x, y, patch.valid);
    paint_voids(patch);
  }
  if (outcome != CE_None) {
    return Error{ErrorCode::kIo,
                 file + ": texels at (" + std::to_string(x) + ", " + std::to_string(y) +
                     ") cannot be read: " + messages.text()};
  }
  return patch;
}

}  // namespace overfly::terrain
