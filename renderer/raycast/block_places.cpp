#include "renderer/raycast/block_places.hpp"

namespace overfly::renderer::raycast {

using terrain::TileId;

namespace {

/// A part of a block.
Block part_of(const Block& block, int x, int y, int columns, int rows) {
  Block part = block;
  part.x = static_cast<std::uint16_t>(block.x + x);
  part.y = static_cast<std::uint16_t>(block.y + y);
  part.columns = static_cast<std::uint8_t>(columns);
  part.rows = static_cast<std::uint8_t>(rows);
  const auto dx = static_cast<float>(x);
  const auto dy = static_cast<float>(y);
  part.numerator_u = moved(block.numerator_u, dx, dy);
  part.numerator_v = moved(block.numerator_v, dx, dy);
  part.inverse_depth = moved(block.inverse_depth, dx, dy);
  part.lod = moved(block.lod, dx, dy);
  part.clear = moved(block.clear, dx, dy);
  return part;
}

}  // namespace

BlockPlaces::BlockPlaces(const terrain::TileSource& tiles, Band& band)
    : tiles_(tiles), band_(band) {}

BlockPlaces::Extent BlockPlaces::extent_of(const Block& block) {
  Extent extent{1e300, -1e300, 1e300, -1e300, 1e30F, -1e30F};
  // The reference quality samples up to a quarter of a pixel beyond the pixels' centres.
  for (const float y : {-0.25F, static_cast<float>(block.rows) - 0.75F}) {
    for (const float x : {-0.25F, static_cast<float>(block.columns) - 0.75F}) {
      const float depth_m = 1.0F / value_at(block.inverse_depth, x, y);
      const double u = block.u + value_at(block.numerator_u, x, y) * depth_m;
      const double v = block.v + value_at(block.numerator_v, x, y) * depth_m;
      const float lod = value_at(block.lod, x, y);
      extent = {std::min(extent.low_u, u),
                std::max(extent.high_u, u),
                std::min(extent.low_v, v),
                std::max(extent.high_v, v),
                std::min(extent.low_lod, lod),
                std::max(extent.high_lod, lod)};
    }
  }
  return extent;
}

void BlockPlaces::add(const Block& block) {
  const Extent extent = extent_of(block);
  const int levels = tiles_.grid().levels;
  const int level = std::clamp(static_cast<int>(std::floor(extent.low_lod)), 0, levels - 1);
  const double texel = 1 << level;  // in texels of level 0
  const double side = terrain::kTileTexels * texel;
  const double col = std::floor(0.5 * (extent.low_u + extent.high_u) / side);
  const double row = std::floor(0.5 * (extent.low_v + extent.high_v) / side);
  // Half a texel of filtering at the coarsest mip level in use.
  const int mips = std::clamp(static_cast<int>(std::floor(extent.high_lod)) - level + 1, 0, 9);
  const double margin = terrain::kTileBorder * texel - 0.5 * texel * (1 << mips);
  const bool inside = extent.low_u >= col * side - margin && extent.low_v >= row * side - margin &&
                      extent.high_u <= (col + 1.0) * side + margin &&
                      extent.high_v <= (row + 1.0) * side + margin;
  const bool single = block.columns == 1 && block.rows == 1;
  const bool top = level == levels - 1;
  if (!single && (!inside || (!top && mips >= kTileMips))) return divide(block);
  if (!(std::abs(col) < 1e9 && std::abs(row) < 1e9)) return;
  Block placed = block;
  placed.tile = index_of({level, static_cast<int>(col), static_cast<int>(row)});
  // A tile without imagery is not read, so that it has no border either.
  if (placed.tile < 0 && !single && meets_imagery(extent, level)) return divide(block);
  if (placed.tile < 0) placed.kind = Block::Kind::kVoid;
  band_.blocks.push_back(placed);
}

void BlockPlaces::divide(const Block& block) {
  const int left = (block.columns + 1) / 2;
  const int upper = (block.rows + 1) / 2;
  add(part_of(block, 0, 0, left, upper));
  if (left < block.columns) add(part_of(block, left, 0, block.columns - left, upper));
  if (upper == block.rows) return;
  add(part_of(block, 0, upper, left, block.rows - upper));
  if (left < block.columns) {
    add(part_of(block, left, upper, block.columns - left, block.rows - upper));
  }
}

bool BlockPlaces::meets_imagery(const Extent& extent, int level) const {
  const double side = terrain::kTileTexels * static_cast<double>(1 << level);
  const auto index = [side](double texel) { return static_cast<int>(std::floor(texel / side)); };
  const int last_row = index(extent.high_v), last_col = index(extent.high_u);
  for (int row = index(extent.low_v); row <= last_row; ++row) {
    for (int col = index(extent.low_u); col <= last_col; ++col) {
      if (tiles_.coverage({level, col, row}) != terrain::TileCoverage::kNone) return true;
    }
  }
  return false;
}

std::int32_t BlockPlaces::index_of(const TileId& id) {
  if (last_ < 0 || band_.tiles[last_] != id) {
    const auto found = std::find(band_.tiles.begin(), band_.tiles.end(), id);
    last_ = static_cast<std::int32_t>(found - band_.tiles.begin());
    if (found == band_.tiles.end()) {
      band_.tiles.push_back(id);
      has_imagery_.push_back(tiles_.coverage(id) != terrain::TileCoverage::kNone);
    }
  }
  return has_imagery_[last_] ? last_ : -1;
}

}  // namespace overfly::renderer::raycast
