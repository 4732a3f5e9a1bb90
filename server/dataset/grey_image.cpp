#include "server/dataset/grey_image.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string>
#include <vector>

#include "core/outside/file_text.hpp"
#include "core/text/lower_case.hpp"
#include "server/camera/camera_shot.hpp"
#include "server/files/jpeg.hpp"
#include "terrain/raster/image_file.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

enum class Kind { kOther, kPng8, kPng16, kJpeg, kPnm };

Error unreadable(const fs::path& file, const std::string& what) {
  return {ErrorCode::kUnreadable, file.string() + ": " + what};
}

/// Detects the format by the first bytes. PNG: byte 25 is the bit depth of a sample (W3C PNG,
/// 11.2.1 IHDR).
Kind kind_of(const std::array<unsigned char, 25>& head) {
  constexpr std::array<unsigned char, 8> kPngSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  if (std::equal(kPngSignature.begin(), kPngSignature.end(), head.begin())) {
    return head[24] == 16 ? Kind::kPng16 : Kind::kPng8;
  }
  if (head[0] == 0xFF && head[1] == 0xD8) return Kind::kJpeg;
  if (head[0] == 'P' && (head[1] == '5' || head[1] == '6')) return Kind::kPnm;
  return Kind::kOther;
}

/// A number of four bytes, the highest first.
std::uint32_t big_endian(const unsigned char* bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8U | bytes[i];
  return value;
}

/// Checks the size that the header states before anything of that size is allocated.
Status check_png_size(const fs::path& file,
                      const std::array<unsigned char, 25>& head,
                      std::int64_t most_pixels) {
  const std::uint32_t width = big_endian(&head[16]);
  const std::uint32_t height = big_endian(&head[20]);
  if (width > kMostImageSidePx || height > kMostImageSidePx) {
    return unreadable(file,
                      std::to_string(width) + " x " + std::to_string(height) +
                          " px: must be at most " + std::to_string(kMostImageSidePx) + " a side");
  }
  const Status pixels = check_image_pixels(width, height, most_pixels);
  if (!pixels) return pixels.error().in(file.string());
  return {};
}

Result<Kind> kind_of(const fs::path& file, std::int64_t most_pixels) {
  if (Status status = check_regular_file(file); !status) return status.error();
  std::ifstream in(file, std::ios::binary);
  if (!in) return Error{ErrorCode::kIo, file.string() + ": cannot be opened for reading"};
  std::array<char, 25> bytes{};
  in.read(bytes.data(), bytes.size());
  if (in.gcount() == 0) return unreadable(file, "is empty (0 bytes)");
  std::array<unsigned char, 25> head{};
  std::copy(bytes.begin(), bytes.end(), head.begin());
  const Kind kind = kind_of(head);
  if (kind == Kind::kPng8 || kind == Kind::kPng16) {
    if (Status status = check_png_size(file, head, most_pixels); !status) return status.error();
  }
  return kind;
}

Result<Image> read_jpeg(const fs::path& file, std::int64_t most_pixels) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 20U;
  const auto bytes = read_file_bytes(file, kMaxBytes);
  if (!bytes) return bytes.error();
  Result<Image> image = decode_jpeg(*bytes, most_pixels);
  if (!image) return image.error().in(file.string());
  return image;
}

Result<Image> read_deep(const fs::path& file, int sample_bits) {
  const Result<Image16> deep = terrain::read_png16(file, kMostImageSidePx);
  if (!deep) return deep.error();
  const unsigned largest = (1U << static_cast<unsigned>(sample_bits)) - 1U;
  const auto shift = static_cast<unsigned>(sample_bits - 8);
  Image image(deep->width_px, deep->height_px, deep->channels);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    if (deep->data[i] > largest) {
      return unreadable(file,
                        "a sample is " + std::to_string(deep->data[i]) + ": must be at most " +
                            std::to_string(largest) + ", of " + std::to_string(sample_bits) +
                            " bit");
    }
    image.data[i] = static_cast<std::uint8_t>(deep->data[i] >> shift);
  }
  return image;
}

Result<Image> read_any(const fs::path& file, Kind kind, int sample_bits, std::int64_t most_pixels) {
  switch (kind) {
    case Kind::kJpeg:
      return read_jpeg(file, most_pixels);
    case Kind::kPng16:
      return read_deep(file, sample_bits);
    case Kind::kPng8:
    case Kind::kPnm:
      return terrain::read_png(file, kMostImageSidePx);
    case Kind::kOther:
      break;
  }
  return unreadable(file, "not an image of a known format: must be PNG, JPEG, PGM or PPM");
}

}  // namespace

Result<Image> read_grey_image(const fs::path& file, int sample_bits, std::int64_t most_pixels) {
  const Result<Kind> kind = kind_of(file, most_pixels);
  if (!kind) return kind.error();
  const Result<Image> image = read_any(file, *kind, sample_bits, most_pixels);
  if (!image) return image.error();
  const Status pixels = check_image_pixels(image->width_px, image->height_px, most_pixels);
  if (!pixels) return pixels.error().in(file.string());
  return grey_of(*image);
}

bool is_image_name(const fs::path& file) {
  const std::string ending = lower_case(file.extension().string());
  constexpr std::array<const char*, 5> kEndings{".png", ".jpg", ".jpeg", ".pgm", ".ppm"};
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace overfly::server
