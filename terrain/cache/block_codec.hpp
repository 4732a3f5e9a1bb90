// Inside terrain only: tiles and blocks of heights as bytes, without loss.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "terrain/height_grid.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::terrain {

using Bytes = std::vector<std::uint8_t>;

/// Colours as differences from green and from the texel to the west, then Zstandard (zlib where
/// GDAL has none). Empty for a tile without a valid texel.
[[nodiscard]] Bytes pack_tile(const Tile& tile);
/// Empty if the bytes are not those of a tile.
[[nodiscard]] std::optional<Tile> unpack_tile(std::span<const std::uint8_t> bytes);

/// Anything else, with its length.
[[nodiscard]] Bytes pack_bytes(const Bytes& plain);
[[nodiscard]] std::optional<Bytes> unpack_bytes(std::span<const std::uint8_t> bytes);

/// Heights as differences of their bit patterns, byte by byte, compressed likewise.
[[nodiscard]] Bytes pack_heights(const HeightGrid& grid);
[[nodiscard]] std::optional<HeightGrid> unpack_heights(std::span<const std::uint8_t> bytes);

}  // namespace overfly::terrain
