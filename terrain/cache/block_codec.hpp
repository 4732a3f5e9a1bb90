// Inside terrain only: lossless encoding of tiles and blocks of heights as bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "terrain/elevation/height_grid.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::terrain {

using Bytes = std::vector<std::uint8_t>;

/// Colours are stored as differences to green and to the texel in the west, then compressed with
/// Zstandard (zlib if GDAL lacks Zstandard). Empty for a tile without a valid texel.
[[nodiscard]] Bytes pack_tile(const Tile& tile);
/// Empty if the bytes are not those of a tile.
[[nodiscard]] std::optional<Tile> unpack_tile(std::span<const std::uint8_t> bytes);

/// Compresses other data, with its length.
[[nodiscard]] Bytes pack_bytes(const Bytes& plain);
[[nodiscard]] std::optional<Bytes> unpack_bytes(std::span<const std::uint8_t> bytes);

/// Heights are stored as differences of their bit patterns, byte by byte, and compressed in the
/// same way.
/// @param grid  a block of (kBlockPosts + 1)^2 posts
[[nodiscard]] Bytes pack_heights(const HeightGrid& grid);
/// Empty if the bytes are not those of a block.
[[nodiscard]] std::optional<HeightGrid> unpack_heights(std::span<const std::uint8_t> bytes);

}  // namespace overfly::terrain
