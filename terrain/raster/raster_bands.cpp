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

/// Reads the texels of a window, which has the size of `size`, into `data` of the given type.
CPLErr read_window(
    GDALRasterBand& band, int x, int y, const Image& size, GDALDataType type, void* data) {
  const int width = size.width_px;
  const int height = size.height_px;
  return band.RasterIO(GF_Read, x, y, width, height, data, width, height, type, 0, 0, nullptr);
}

/// The smallest value of a band of transparency that counts as opaque.
float least_opaque(GDALDataType type) {
  switch (type) {
    case GDT_Byte:
      return 128.0F;
    case GDT_UInt16:
      return 32768.0F;
    case GDT_Int16:
      return 16384.0F;
    default:
      return std::numeric_limits<float>::min();
  }
}

/// GDAL's progress callback, called between rows: whether reading continues.
int CPL_STDCALL ask(double, const char*, void* cancelled) {
  const auto& asked = *static_cast<const Cancelled*>(cancelled);
  return asked && asked() ? FALSE : TRUE;
}

/// Leaves out what is void by transparency or a mask; in `sample` it becomes NaN.
CPLErr leave_out_voids(GDALDataset& dataset,
                       GDALRasterBand& band,
                       int alpha,
                       int width,
                       int height,
                       std::vector<float>& sample) {
  if (alpha == 0 && (band.GetMaskFlags() & GMF_ALL_VALID) != 0) return CE_None;
  GDALRasterBand* const mask = alpha > 0 ? dataset.GetRasterBand(alpha) : band.GetMaskBand();
  const float least = alpha > 0 ? least_opaque(mask->GetRasterDataType()) : 128.0F;
  std::vector<float> opacity(sample.size());
  const CPLErr outcome = mask->RasterIO(GF_Read,
                                        0,
                                        0,
                                        mask->GetXSize(),
                                        mask->GetYSize(),
                                        opacity.data(),
                                        width,
                                        height,
                                        GDT_Float32,
                                        0,
                                        0,
                                        nullptr);
  for (std::size_t i = 0; outcome == CE_None && i < sample.size(); ++i) {
    if (opacity[i] < least) sample[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return outcome;
}

/// Adds a sample of one band's values, without those that mark voids.
/// @param alpha  as RasterBands::alpha
Status add_sample(GDALDataset& dataset,
                  int band_number,
                  const std::string& file,
                  int alpha,
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
                     &questions) != CE_None ||
      (!void_value && leave_out_voids(dataset, *band, alpha, width, height, sample) != CE_None)) {
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
    Status added =
        add_sample(dataset, bands.rgb[c], file, bands.alpha, bands.nodata, cancelled, sample);
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

/// @param has_value  one element a texel; left at 0 where no colour band has a finite value
CPLErr read_rescaled(GDALDataset& dataset,
                     const RasterBands& bands,
                     int x,
                     int y,
                     Image& rgb,
                     std::vector<std::uint8_t>& has_value) {
  std::vector<float> values(has_value.size());
  for (int c = 0; c < 3; ++c) {
    const CPLErr outcome =
        read_window(*dataset.GetRasterBand(bands.rgb[c]), x, y, rgb, GDT_Float32, values.data());
    if (outcome != CE_None) return outcome;
    const double factor = 255.0 / (bands.high - bands.low);
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::uint8_t& shown = rgb.data[3 * i + c];
      shown = 0;
      if (!std::isfinite(values[i])) continue;
      const double scaled = std::clamp((values[i] - bands.low) * factor, 0.0, 255.0);
      shown = static_cast<std::uint8_t>(std::lround(scaled));
      has_value[i] = 1;
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
    const CPLErr outcome =
        read_window(*dataset.GetRasterBand(bands.rgb[c]), x, y, valid, GDT_Float32, values.data());
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

CPLErr read_alpha(GDALDataset& dataset, const RasterBands& bands, int x, int y, Image& valid) {
  GDALRasterBand& alpha = *dataset.GetRasterBand(bands.alpha);
  std::vector<float> values(valid.data.size());
  const CPLErr outcome = read_window(alpha, x, y, valid, GDT_Float32, values.data());
  if (outcome != CE_None) return outcome;
  const float least = least_opaque(alpha.GetRasterDataType());
  for (std::size_t i = 0; i < values.size(); ++i) valid.data[i] = values[i] >= least ? 255 : 0;
  return CE_None;
}

/// A texel is void if every colour band says so (nodata 0 must not mask a dark red).
CPLErr read_mask(GDALDataset& dataset, const RasterBands& bands, int x, int y, Image& valid) {
  if (bands.nodata) return read_nodata(dataset, bands, x, y, valid);
  if (bands.alpha > 0) return read_alpha(dataset, bands, x, y, valid);
  std::fill(valid.data.begin(), valid.data.end(), std::uint8_t{0});
  Image one(valid.width_px, valid.height_px, 1);
  for (int c = 0; c < 3; ++c) {
    if (c > 0 && bands.rgb[c] == bands.rgb[0]) break;
    GDALRasterBand* band = dataset.GetRasterBand(bands.rgb[c]);
    const int flags = band->GetMaskFlags();
    const CPLErr outcome =
        read_window(*band->GetMaskBand(), x, y, valid, GDT_Byte, one.data.data());
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
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  if (read_window(band, x, y, valid, GDT_Byte, index.data.data()) != CE_None) {
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
  if (!nodata && !has_mask(dataset, bands)) bands.alpha = band_of(dataset, GCI_AlphaBand);
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
  const bool may_be_nan = GDALDataTypeIsFloating(bands.type) != 0;
  bands.has_mask = bands.has_mask || bands.nodata || bands.alpha > 0 || bands.unwritten ||
                   may_be_nan || has_mask(dataset, bands);
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
  std::vector<std::uint8_t> has_value(bands.rescaled ? patch.valid.data.size() : 0, 0);
  CPLErr outcome = bands.rescaled ? read_rescaled(dataset, bands, x, y, patch.rgb, has_value)
                                  : read_bytes(dataset, bands, x, y, patch.rgb);
  if (outcome == CE_None && bands.has_mask) {
    outcome = read_mask(dataset, bands, x, y, patch.valid);
    if (bands.palette) mask_palette(dataset, bands, x, y, patch.valid);
    if (bands.unwritten) mask_unwritten(dataset, bands, x, y, patch.valid);
    for (std::size_t i = 0; i < has_value.size(); ++i) {
      if (has_value[i] == 0) patch.valid.data[i] = 0;
    }
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
