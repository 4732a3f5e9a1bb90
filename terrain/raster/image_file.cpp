#include "terrain/raster/image_file.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>

#include <string_view>

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

/// Checks the declared size before anything of that size is allocated.
Status check_size(GDALDataset& source, const fs::path& file, std::uint32_t most_side_px) {
  const auto width = static_cast<std::uint32_t>(source.GetRasterXSize());
  const auto height = static_cast<std::uint32_t>(source.GetRasterYSize());
  if (width <= most_side_px && height <= most_side_px) return {};
  return Error{ErrorCode::kUnreadable,
               file.string() + ": " + std::to_string(width) + " x " + std::to_string(height) +
                   " px: must be at most " + std::to_string(most_side_px) + " a side"};
}

/// PGM and PPM are not compressed: GDAL opens a file of a few bytes with any size in its header.
Status check_pnm_length(GDALDataset& source, const fs::path& file, std::uint64_t sample_bytes) {
  if (std::string_view(source.GetDriver()->GetDescription()) != "PNM") return {};
  const std::uint64_t width = source.GetRasterXSize();
  const std::uint64_t height = source.GetRasterYSize();
  const std::uint64_t least = width * height * source.GetRasterCount() * sample_bytes;
  std::error_code failed;
  const std::uintmax_t length = fs::file_size(file, failed);
  if (failed) return Error{ErrorCode::kIo, file.string() + ": " + failed.message()};
  if (length >= least) return {};
  return Error{ErrorCode::kUnreadable,
               file.string() + ": " + std::to_string(length) + " bytes: must be at least " +
                   std::to_string(least) + " for " + std::to_string(width) + " x " +
                   std::to_string(height) + " px"};
}

/// Reads the whole file, samples of one pixel together.
template <typename Sample>
Result<ImageBuffer<Sample>> read_samples(GDALDataset& source,
                                         const fs::path& file,
                                         std::uint32_t most_side_px) {
  const GDALDataType type = sizeof(Sample) == 2 ? GDT_UInt16 : GDT_Byte;
  if (source.GetRasterBand(1)->GetRasterDataType() != type) {
    return Error{
        ErrorCode::kUnreadable,
        file.string() + ": samples are not " + std::to_string(8 * sizeof(Sample)) + " bit"};
  }
  if (Status status = check_size(source, file, most_side_px); !status) return status.error();
  if (Status status = check_pnm_length(source, file, sizeof(Sample)); !status) {
    return status.error();
  }
  ImageBuffer<Sample> image(
      source.GetRasterXSize(), source.GetRasterYSize(), source.GetRasterCount() >= 3 ? 3 : 1);
  const GSpacing sample_bytes = sizeof(Sample);
  const GdalMessages messages;
  if (source.RasterIO(GF_Read,
                      0,
                      0,
                      image.width_px,
                      image.height_px,
                      image.data.data(),
                      image.width_px,
                      image.height_px,
                      type,
                      image.channels,
                      nullptr,
                      sample_bytes * image.channels,
                      sample_bytes * image.channels * image.width_px,
                      sample_bytes,
                      nullptr) != CE_None) {
    return Error{ErrorCode::kUnreadable, file.string() + ": " + messages.text()};
  }
  return image;
}

}  // namespace

Status write_png(const fs::path& file, const Image& image) {
  return write_png_of(file, image, GDT_Byte);
}

Status write_png(const fs::path& file, const Image16& image) {
  return write_png_of(file, image, GDT_UInt16);
}

Result<Image16> read_png16(const fs::path& file, std::uint32_t most_side_px) {
  auto dataset = open_raster(file);
  if (!dataset) return dataset.error();
  return read_samples<std::uint16_t>(**dataset, file, most_side_px);
}

Result<Image> read_png(const fs::path& file, std::uint32_t most_side_px) {
  auto dataset = open_raster(file);
  if (!dataset) return dataset.error();
  Result<Image> read = read_samples<std::uint8_t>(**dataset, file, most_side_px);
  if (!read) return read;
  const Image& image = *read;
  const GDALColorTable* palette = (*dataset)->GetRasterBand(1)->GetColorTable();
  if (image.channels == 3 || palette == nullptr) return read;
  Image coloured(image.width_px, image.height_px, 3);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    GDALColorEntry entry{};  // black for an index outside the palette
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
