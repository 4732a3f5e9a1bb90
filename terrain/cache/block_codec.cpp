#include "terrain/cache/block_codec.hpp"

#include <cpl_compressor.h>
#include <cpl_conv.h>
#include <cpl_string.h>

#include <algorithm>
#include <bit>

#include "terrain/elevation/height_blocks.hpp"

namespace overfly::terrain {
namespace {

constexpr const char* kMethods[] = {"zstd", "zlib"};

enum TileFlag : std::uint8_t { kGrey = 1, kMasked = 2 };

/// First byte: the method, index into kMethods.
Bytes compress(const Bytes& plain) {
  for (std::size_t method = 0; method < std::size(kMethods); ++method) {
    const CPLCompressor* compressor = CPLGetCompressor(kMethods[method]);
    if (compressor == nullptr) continue;
    CPLStringList options;
    options.SetNameValue("LEVEL", "3");
    void* out = nullptr;
    std::size_t size = 0;
    if (!compressor->pfnFunc(
            plain.data(), plain.size(), &out, &size, options.List(), compressor->user_data)) {
      continue;
    }
    const auto* begin = static_cast<const std::uint8_t*>(out);
    Bytes packed(size + 1);
    packed[0] = static_cast<std::uint8_t>(method);
    std::copy(begin, begin + size, packed.begin() + 1);
    VSIFree(out);
    return packed;
  }
  return {};
}

std::optional<Bytes> decompress(std::span<const std::uint8_t> packed, std::size_t plain_size) {
  if (packed.empty() || packed[0] >= std::size(kMethods)) return std::nullopt;
  const CPLCompressor* method = CPLGetDecompressor(kMethods[packed[0]]);
  if (method == nullptr) return std::nullopt;
  Bytes plain(plain_size);
  void* out = plain.data();
  std::size_t size = plain_size;
  const bool done = method->pfnFunc(
      packed.data() + 1, packed.size() - 1, &out, &size, nullptr, method->user_data);
  if (!done || size != plain_size) return std::nullopt;
  return plain;
}

bool is_grey(const Tile& tile) {
  const std::vector<std::uint8_t>& rgb = tile.rgb.data;
  for (std::size_t i = 0; i < tile.valid.data.size(); ++i) {
    if (tile.valid.data[i] == 0) continue;
    if (rgb[3 * i] != rgb[3 * i + 1] || rgb[3 * i] != rgb[3 * i + 2]) return false;
  }
  return true;
}

constexpr std::size_t kTexels = std::size_t{kTileSide} * kTileSide;

/// Writes one plane as differences to the west along each row.
void write_plane(const std::uint8_t* values, Bytes& out) {
  for (int y = 0; y < kTileSide; ++y) {
    std::uint8_t before = 0;
    for (int x = 0; x < kTileSide; ++x) {
      const std::uint8_t value = *values++;
      out.push_back(static_cast<std::uint8_t>(value - before));
      before = value;
    }
  }
}

const std::uint8_t* read_plane(const std::uint8_t* in, std::uint8_t* values) {
  for (int y = 0; y < kTileSide; ++y) {
    std::uint8_t value = 0;
    for (int x = 0; x < kTileSide; ++x)
      *values++ = value = static_cast<std::uint8_t>(value + *in++);
  }
  return in;
}

}  // namespace

Bytes pack_bytes(const Bytes& plain) {
  Bytes packed;
  for (int i = 0; i < 8; ++i) {
    packed.push_back(static_cast<std::uint8_t>(std::uint64_t{plain.size()} >> (8 * i)));
  }
  const Bytes rest = compress(plain);
  packed.insert(packed.end(), rest.begin(), rest.end());
  return packed;
}

std::optional<Bytes> unpack_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 8) return std::nullopt;
  std::uint64_t size = 0;
  for (int i = 0; i < 8; ++i) size |= static_cast<std::uint64_t>(bytes[i]) << (8 * i);
  constexpr std::uint64_t kLargest = std::uint64_t{256} << 20U;
  if (size > kLargest) return std::nullopt;
  return decompress(bytes.subspan(8), size);
}

Bytes pack_tile(const Tile& tile) {
  const auto& valid = tile.valid.data;
  if (std::find(valid.begin(), valid.end(), std::uint8_t{255}) == valid.end()) return {};
  const bool masked = std::find(valid.begin(), valid.end(), std::uint8_t{0}) != valid.end();
  const bool grey = is_grey(tile);
  Bytes plain;
  plain.reserve(kTexels * 4 + 1);
  plain.push_back(static_cast<std::uint8_t>((grey ? kGrey : 0) | (masked ? kMasked : 0)));
  Bytes plane(kTexels);
  const std::uint8_t* rgb = tile.rgb.data.data();
  for (std::size_t i = 0; i < kTexels; ++i) plane[i] = rgb[3 * i + 1];
  write_plane(plane.data(), plain);
  for (int c = 0; !grey && c < 3; c += 2) {
    for (std::size_t i = 0; i < kTexels; ++i) {
      plane[i] = static_cast<std::uint8_t>(rgb[3 * i + c] - rgb[3 * i + 1]);
    }
    write_plane(plane.data(), plain);
  }
  if (masked) write_plane(valid.data(), plain);
  Bytes packed = compress(plain);
  packed.insert(packed.begin(), plain[0]);
  return packed;
}

std::optional<Tile> unpack_tile(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes[0] > (kGrey | kMasked)) return std::nullopt;
  const bool grey = (bytes[0] & kGrey) != 0;
  const bool masked = (bytes[0] & kMasked) != 0;
  const std::size_t planes = (grey ? 1 : 3) + (masked ? 1 : 0);
  const auto plain = decompress(bytes.subspan(1), kTexels * planes + 1);
  if (!plain) return std::nullopt;
  Tile tile{Image(kTileSide, kTileSide, 3), Image(kTileSide, kTileSide, 1, 255)};
  std::uint8_t* rgb = tile.rgb.data.data();
  const std::uint8_t* in = plain->data() + 1;
  Bytes green(kTexels);
  Bytes plane(kTexels);
  in = read_plane(in, green.data());
  for (int c = 0; c < 3; ++c) {
    if (!grey && c != 1) in = read_plane(in, plane.data());
    const bool difference = !grey && c != 1;
    for (std::size_t i = 0; i < kTexels; ++i) {
      rgb[3 * i + c] = difference ? static_cast<std::uint8_t>(green[i] + plane[i]) : green[i];
    }
  }
  if (masked) {
    read_plane(in, tile.valid.data.data());
    for (std::size_t i = 0; i < kTexels; ++i) {
      if (tile.valid.data[i] == 0) std::copy_n(kVoidRgb, 3, rgb + 3 * i);
    }
  }
  return tile;
}

Bytes pack_heights(const HeightGrid& grid) {
  const std::size_t count = grid.heights_m.size();
  Bytes plain(4 * count);
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(grid.heights_m[i]);
    const std::uint32_t difference = bits - before;
    before = bits;
    for (int byte = 0; byte < 4; ++byte) {
      plain[byte * count + i] = static_cast<std::uint8_t>(difference >> (8 * byte));
    }
  }
  Bytes packed = compress(plain);
  const auto side = static_cast<std::uint16_t>(grid.columns);
  packed.insert(packed.begin(),
                {static_cast<std::uint8_t>(side), static_cast<std::uint8_t>(side >> 8U)});
  return packed;
}

std::optional<HeightGrid> unpack_heights(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 3) return std::nullopt;
  HeightGrid grid;
  grid.columns = bytes[0] | bytes[1] << 8;
  if (grid.columns != kBlockPosts + 1) return std::nullopt;
  grid.rows = grid.columns;
  const std::size_t count = static_cast<std::size_t>(grid.columns) * grid.rows;
  const auto plain = decompress(bytes.subspan(2), 4 * count);
  if (!plain) return std::nullopt;
  grid.heights_m.resize(count);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t difference = 0;
    for (int byte = 0; byte < 4; ++byte) {
      difference |= static_cast<std::uint32_t>((*plain)[byte * count + i]) << (8 * byte);
    }
    bits += difference;
    grid.heights_m[i] = std::bit_cast<float>(bits);
  }
  return grid;
}

}  // namespace overfly::terrain
