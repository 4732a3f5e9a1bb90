// PNG (W3C Recommendation, 3rd edition, 2025): sections 5.3 chunks, 9.2 filter "up", 10 zlib.
#include "server/files/png_file.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "server/files/whole_file.hpp"

namespace overfly::server {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_u32(std::uint32_t value, Bytes& out) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    out.push_back(static_cast<std::uint8_t>(value >> static_cast<unsigned>(shift)));
  }
}

void put_chunk(const char* type, const Bytes& data, Bytes& out) {
  put_u32(static_cast<std::uint32_t>(data.size()), out);
  const std::size_t begin = out.size();
  out.insert(out.end(), type, type + 4);
  out.insert(out.end(), data.begin(), data.end());
  put_u32(libdeflate_crc32(0, out.data() + begin, out.size() - begin), out);
}

/// Copies a row of samples in file order: high byte of 16 bits first.
void copy_row(const std::uint8_t* row, std::size_t samples, std::uint8_t* out) {
  std::copy(row, row + samples, out);
}
void copy_row(const std::uint16_t* row, std::size_t samples, std::uint8_t* out) {
  for (std::size_t i = 0; i < samples; ++i) {
    out[2 * i] = static_cast<std::uint8_t>(row[i] >> 8U);
    out[2 * i + 1] = static_cast<std::uint8_t>(row[i] & 0xFFU);
  }
}

/// Each row is preceded by its filter type: 2 = difference to the row above.
template <typename T>
Bytes filtered(const ImageBuffer<T>& image) {
  const std::size_t samples = static_cast<std::size_t>(image.width_px) * image.channels;
  const std::size_t row_bytes = samples * sizeof(T);
  Bytes out((row_bytes + 1) * static_cast<std::size_t>(image.height_px));
  Bytes above(row_bytes, 0);
  Bytes row(row_bytes);
  for (int y = 0; y < image.height_px; ++y) {
    copy_row(&image.at(0, y), samples, row.data());
    std::uint8_t* target = out.data() + static_cast<std::size_t>(y) * (row_bytes + 1);
    *target++ = 2;
    for (std::size_t i = 0; i < row_bytes; ++i) {
      target[i] = static_cast<std::uint8_t>(row[i] - above[i]);
    }
    above.swap(row);
  }
  return out;
}

Bytes compressed(const Bytes& plain) {
  constexpr int kFastest = 1;
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(kFastest), libdeflate_free_compressor);
  Bytes out(libdeflate_zlib_compress_bound(compressor.get(), plain.size()));
  out.resize(libdeflate_zlib_compress(
      compressor.get(), plain.data(), plain.size(), out.data(), out.size()));
  return out;
}

template <typename T>
Bytes encode(const ImageBuffer<T>& image) {
  Bytes header;
  put_u32(static_cast<std::uint32_t>(image.width_px), header);
  put_u32(static_cast<std::uint32_t>(image.height_px), header);
  header.push_back(8 * sizeof(T));  // bits a sample
  header.push_back(image.channels == 4 ? 6 : image.channels == 3 ? 2 : 0);
  header.insert(header.end(), {0, 0, 0});  // deflate, adaptive filters, not interlaced
  Bytes out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  put_chunk("IHDR", header, out);
  put_chunk("IDAT", compressed(filtered(image)), out);
  put_chunk("IEND", {}, out);
  return out;
}

template <typename T>
Status write(const std::filesystem::path& file, const ImageBuffer<T>& image) {
  const bool known = image.channels == 1 || image.channels == 3 || image.channels == 4;
  if (image.empty() || !known) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": image of " + std::to_string(image.width_px) + " x " +
                     std::to_string(image.height_px) + " px with " +
                     std::to_string(image.channels) + " channels: must have 1, 3 or 4, not empty"};
  }
  const Bytes bytes = encode(image);
  return write_whole(file, std::span<const std::uint8_t>(bytes));
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image) { return encode(image); }
std::vector<std::uint8_t> encode_png(const Image16& image) { return encode(image); }

Status write_png_file(const std::filesystem::path& file, const Image& image) {
  return write(file, image);
}
Status write_png_file(const std::filesystem::path& file, const Image16& image) {
  return write(file, image);
}

}  // namespace overfly::server
