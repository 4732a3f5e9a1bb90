#include "terrain/raster/image_file.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>

#include "terrain/raster/gdal_dataset.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

Error cannot_write(const fs::path& file, const std::string& reason) {
  return {ErrorCode::kIo, file.string() + ": cannot be written: " + reason};
}

/// An image in memory, in the form that GDAL's drivers copy from.
DatasetPtr in_memory(const void* data, int width, int height, int channels, GDALDataType type) {
  auto* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  DatasetPtr dataset(driver->Create("", width, height, channels, type, nullptr));
  if (!dataset) return nullptr;
  const int bytes = GDALGetDataTypeSizeBytes(type);
  const CPLErr outcome = dataset->RasterIO(GF_Write,
                                           0,
                                           0,
                                           width,
                                           height,
                                           const_cast<void*>(data),
                                           width,
                                           height,
                                           type,
                                           channels,
                                           nullptr,
                                           GSpacing{bytes} * channels,
                                           GSpacing{bytes} * channels * width,
                                           bytes,
                                           nullptr);
  return outcome == CE_None ? std::move(dataset) : nullptr;
}

/// Writes to a temporary name and renames, so that no partial file is visible.
Status copy_to(GDALDataset* source, const char* format, const fs::path& file, char** options) {
  const GdalMessages messages;
  if (source == nullptr) return cannot_write(file, messages.text());
  auto* driver = GetGDALDriverManager()->GetDriverByName(format);
  if (driver == nullptr) {
    return Error{ErrorCode::kUnsupported, std::string("GDAL has no driver for ") + format};
  }
  fs::path part = file;
  part += ".part";
  // Otherwise the copy would store statistics and colours in a side-car file.
  CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", "NO");
  CPLErrorReset();
  DatasetPtr written(driver->CreateCopy(part.c_str(), source, 0, options, nullptr, nullptr));
  if (written != nullptr) written->FlushCache(true);
  const bool good = written != nullptr && CPLGetLastErrorType() < CE_Failure;
  written.reset();
  CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr);
  std::error_code failed;
  if (good) fs::rename(part, file, failed);
  if (good && !failed) return {};
  const std::string reason = failed ? failed.message() : messages.text();
  fs::remove(part, failed);
  return cannot_write(file, reason);
}

template <typename T>
Status write_png_of(const fs::path& file, const ImageBuffer<T>& image, GDALDataType type) {
  initialise_gdal();
  if (image.empty() || (image.channels != 1 && image.channels != 3)) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": image of " + std::to_string(image.width_px) + " x " +
                     std::to_string(image.height_px) + " px with " +
                     std::to_string(image.channels) + " channels: must be grey or RGB, not empty"};
  }
  const DatasetPtr source =
      in_memory(image.data.data(), image.width_px, image.height_px, image.channels, type);
  CPLStringList options;
  options.SetNameValue("ZLEVEL", "4");
  return copy_to(source.get(), "PNG", file, options.List());
}

}  // namespace

Status write_png(const fs::path& file, const Image& image) {
  return write_png_of(file, image, GDT_Byte);
}

Status write_png(const fs::path& file, const Image16& image) {
  return write_png_of(file, image, GDT_UInt16);
}

Result<Image16> read_png16(const fs::path& file) {
  auto dataset = open_raster(file);
  if (!dataset) return dataset.error();
  GDALDataset& source = **dataset;
  if (source.GetRasterBand(1)->GetRasterDataType() != GDT_UInt16) {
    return Error{ErrorCode::kUnreadable, file.string() + ": samples are not 16 bit"};
  }
  Image16 image(
      source.GetRasterXSize(), source.GetRasterYSize(), source.GetRasterCount() >= 3 ? 3 : 1);
  const GdalMessages messages;
  if (source.RasterIO(GF_Read,
                      0,
                      0,
                      image.width_px,
                      image.height_px,
                      image.data.data(),
                      image.width_px,
                      image.height_px,
                      GDT_UInt16,
                      image.channels,
                      nullptr,
                      GSpacing{2} * image.channels,
                      GSpacing{2} * image.channels * image.width_px,
                      2,
                      nullptr) != CE_None) {
    return Error{ErrorCode::kUnreadable, file.string() + ": " + messages.text()};
  }
  return image;
}

Result<Image> read_png(const fs::path& file) {
  auto dataset = open_raster(file);
  if (!dataset) return dataset.error();
  GDALDataset& source = **dataset;
  const GDALColorTable* palette = source.GetRasterBand(1)->GetColorTable();
  const int bands = source.GetRasterCount() >= 3 ? 3 : 1;
  if (source.GetRasterBand(1)->GetRasterDataType() != GDT_Byte) {
    return Error{ErrorCode::kUnreadable, file.string() + ": samples are not 8 bit"};
  }
  Image image(source.GetRasterXSize(), source.GetRasterYSize(), bands);
  const GdalMessages messages;
  if (source.RasterIO(GF_Read,
                      0,
                      0,
                      image.width_px,
                      image.height_px,
                      image.data.data(),
                      image.width_px,
                      image.height_px,
                      GDT_Byte,
                      bands,
                      nullptr,
                      bands,
                      GSpacing{bands} * image.width_px,
                      1,
                      nullptr) != CE_None) {
    return Error{ErrorCode::kUnreadable, file.string() + ": " + messages.text()};
  }
  if (bands == 3 || palette == nullptr) return image;
  Image coloured(image.width_px, image.height_px, 3);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    GDALColorEntry entry;
    palette->GetColorEntryAsRGB(image.data[i], &entry);
    coloured.data[3 * i] = static_cast<std::uint8_t>(entry.c1);
    coloured.data[3 * i + 1] = static_cast<std::uint8_t>(entry.c2);
    coloured.data[3 * i + 2] = static_cast<std::uint8_t>(entry.c3);
  }
  return coloured;
}

Status write_geotiff_depth(const fs::path& file, const DepthImage& depth) {
  initialise_gdal();
  if (depth.empty() || depth.channels != 1) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": depth image of " + std::to_string(depth.width_px) + " x " +
                     std::to_string(depth.height_px) + " px with " +
                     std::to_string(depth.channels) + " channels: must have one, not empty"};
  }
  const DatasetPtr source =
      in_memory(depth.data.data(), depth.width_px, depth.height_px, 1, GDT_Float32);
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "3");
  return copy_to(source.get(), "GTiff", file, options.List());
}

namespace {

template <typename T>
Status write_floats(const fs::path& file, const ImageBuffer<T>& image, GDALDataType type) {
  initialise_gdal();
  if (image.empty() || (image.channels != 1 && image.channels != 3)) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": image of " + std::to_string(image.width_px) + " x " +
                     std::to_string(image.height_px) + " px with " +
                     std::to_string(image.channels) +
                     " channels: must have one or three, not empty"};
  }
  const DatasetPtr source =
      in_memory(image.data.data(), image.width_px, image.height_px, image.channels, type);
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "3");
  options.SetNameValue("ZLEVEL", "1");
  options.SetNameValue("INTERLEAVE", "PIXEL");
  options.SetNameValue("PHOTOMETRIC", image.channels == 3 ? "RGB" : "MINISBLACK");
  return copy_to(source.get(), "GTiff", file, options.List());
}

}  // namespace

Status write_tiff(const fs::path& file, const ImageBuffer<float>& image) {
  return write_floats(file, image, GDT_Float32);
}

Status write_tiff(const fs::path& file, const ImageBuffer<double>& image) {
  return write_floats(file, image, GDT_Float64);
}

}  // namespace overfly::terrain
