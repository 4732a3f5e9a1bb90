#include "server/imagery/grey_picture.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/outside/file_descriptor.hpp"
#include "server/camera/camera_shot.hpp"
#include "server/dataset/grey_image.hpp"
#include "server/files/jpeg.hpp"

namespace overfly::server {
namespace {

using flight::logs::LoggedPicture;

std::uint8_t luma_of(int red, int green, int blue) {
  return static_cast<std::uint8_t>((299 * red + 587 * green + 114 * blue + 500) / 1000);
}

/// How the samples of a pixel are stored.
struct PixelLayout {
  std::string_view encoding;
  int bytes;  ///< of a pixel
  int red, green, blue;
};

constexpr PixelLayout kColourLayouts[] = {
    {"rgb8", 3, 0, 1, 2},
    {"bgr8", 3, 2, 1, 0},
    {"8UC3", 3, 2, 1, 0},
    {"rgba8", 4, 0, 1, 2},
    {"bgra8", 4, 2, 1, 0},
    {"8UC4", 4, 2, 1, 0},
};

/// One sample of each pixel is the grey value.
struct GreyLayout {
  std::string_view encoding;
  int step;   ///< bytes from one pixel to the next
  int first;  ///< byte of the first pixel's sample; of 16 bit: -1
};

constexpr GreyLayout kGreyLayouts[] = {
    {"mono8", 1, 0},
    {"8UC1", 1, 0},
    {"mono16", 2, -1},
    {"16UC1", 2, -1},
    {"yuv422", 2, 1},
    {"uyvy", 2, 1},
    {"yuyv", 2, 0},
    {"yuv422_yuy2", 2, 0},
};

/// Colours of the top left pixel, its right neighbour, and the two below: R, G or B.
struct BayerLayout {
  std::string_view encoding;
  char colours[5];
};

constexpr BayerLayout kBayerLayouts[] = {
    {"bayer_rggb8", "RGGB"},
    {"bayer_bggr8", "BGGR"},
    {"bayer_gbrg8", "GBRG"},
    {"bayer_grbg8", "GRBG"},
};

const std::uint8_t* picture_row(const LoggedPicture& picture, int y) {
  return picture.data.data() + static_cast<std::size_t>(y) * picture.row_bytes;
}

Image grey_from(const LoggedPicture& picture, const GreyLayout& layout) {
  Image grey(picture.width_px, picture.height_px, 1);
  const int first = layout.first < 0 ? (picture.big_endian ? 0 : 1) : layout.first;
  for (int y = 0; y < grey.height_px; ++y) {
    const std::uint8_t* const row = picture_row(picture, y);
    for (int x = 0; x < grey.width_px; ++x) grey.at(x, y) = row[layout.step * x + first];
  }
  return grey;
}

Image grey_from(const LoggedPicture& picture, const PixelLayout& layout) {
  Image grey(picture.width_px, picture.height_px, 1);
  for (int y = 0; y < grey.height_px; ++y) {
    const std::uint8_t* pixel = picture_row(picture, y);
    for (int x = 0; x < grey.width_px; ++x, pixel += layout.bytes) {
      grey.at(x, y) = luma_of(pixel[layout.red], pixel[layout.green], pixel[layout.blue]);
    }
  }
  return grey;
}

/// Bilinear: a colour that the pixel has not is the mean of its nearest neighbours that have it.
Image grey_from(const LoggedPicture& picture, const BayerLayout& layout) {
  Image grey(picture.width_px, picture.height_px, 1);
  const auto colour_at = [&](int x, int y) {
    const char colour = layout.colours[2 * (y & 1) + (x & 1)];
    return colour == 'R' ? 0U : colour == 'G' ? 1U : 2U;
  };
  for (int y = 0; y < grey.height_px; ++y) {
    for (int x = 0; x < grey.width_px; ++x) {
      std::array<int, 3> sums{};
      std::array<int, 3> weights{};
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
          if (x + i < 0 || y + j < 0 || x + i >= grey.width_px || y + j >= grey.height_px) continue;
          const int weight = (2 - (i & 1)) * (2 - (j & 1));
          const unsigned colour = colour_at(x + i, y + j);
          sums[colour] += weight * picture_row(picture, y + j)[x + i];
          weights[colour] += weight;
        }
      }
      const unsigned own = colour_at(x, y);
      sums[own] = picture_row(picture, y)[x];
      weights[own] = 1;
      const auto value = [&](std::size_t c) { return weights[c] > 0 ? sums[c] / weights[c] : 0; };
      grey.at(x, y) = luma_of(value(0), value(1), value(2));
    }
  }
  return grey;
}

/// PNG is read from files: this one is removed at once.
Result<Image> image_in_file(std::span<const std::uint8_t> bytes, std::int64_t most_pixels) {
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
  std::string name = (failed ? "/tmp" : folder.string()) + "/overfly-image-XXXXXX";
  const FileDescriptor file(::mkostemp(name.data(), O_CLOEXEC));
  if (!file.open()) return Error{ErrorCode::kIo, name + ": cannot be created"};
  const struct Removal {
    const std::string& name;
    ~Removal() { ::unlink(name.c_str()); }
  } removal{name};
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t step = ::write(file.get(), bytes.data() + written, bytes.size() - written);
    if (step <= 0) return Error{ErrorCode::kIo, name + ": cannot be written"};
    written += static_cast<std::size_t>(step);
  }
  return read_grey_image(name, 16, most_pixels);
}

Result<Image> decoded(std::span<const std::uint8_t> bytes, std::int64_t most_pixels) {
  const bool jpeg = bytes.size() > 2 && bytes[0] == 0xFF && bytes[1] == 0xD8;
  if (!jpeg) return image_in_file(bytes, most_pixels);
  Result<Image> image = decode_jpeg(bytes, most_pixels);
  if (!image) return image;
  return grey_of(*image);
}

template <typename Layout, std::size_t N>
const Layout* layout_named(const Layout (&layouts)[N], std::string_view encoding) {
  for (const Layout& layout : layouts) {
    if (layout.encoding == encoding) return &layout;
  }
  return nullptr;
}

}  // namespace

Result<Image> grey_picture(const LoggedPicture& picture, std::int64_t most_pixels) {
  if (picture.encoding == "compressed") return decoded(picture.data, most_pixels);
  const auto width = static_cast<std::size_t>(picture.width_px);
  const auto fits = [&](int bytes) {
    return picture.row_bytes / static_cast<std::size_t>(bytes) >= width;
  };
  const Error narrow{ErrorCode::kUnreadable,
                     "rows of " + std::to_string(picture.row_bytes) + " bytes are too short for " +
                         std::to_string(picture.width_px) + " px of " + picture.encoding};
  if (const auto* grey = layout_named(kGreyLayouts, picture.encoding)) {
    if (!fits(grey->step)) return narrow;
    return grey_from(picture, *grey);
  }
  if (const auto* colour = layout_named(kColourLayouts, picture.encoding)) {
    if (!fits(colour->bytes)) return narrow;
    return grey_from(picture, *colour);
  }
  if (const auto* bayer = layout_named(kBayerLayouts, picture.encoding)) {
    return grey_from(picture, *bayer);
  }
  return Error{ErrorCode::kUnsupported,
               "encoding \"" + picture.encoding.substr(0, 40) + "\": is not read"};
}

}  // namespace overfly::server
