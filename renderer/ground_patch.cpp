#include "renderer/ground_patch.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::renderer {

using terrain::TileCoverage;
using terrain::TileId;

namespace {

constexpr double kEarthRadiusM = 6371000.0;
constexpr std::size_t kMaxPatches = 6000;  // some 60 MB when a quarter of them is sampled

/// Largest distance between the ground's points in a square and the square's two triangles, which
/// meet on the diagonal from the north-east to the south-west.
double square_error_m(const GroundPatch& patch, int column, int row, int cells) {
  const Eigen::Vector3d& north_west = patch.point(column, row);
  const Eigen::Vector3d& north_east = patch.point(column + cells, row);
  const Eigen::Vector3d& south_west = patch.point(column, row + cells);
  const Eigen::Vector3d& south_east = patch.point(column + cells, row + cells);
  const double scale = 1.0 / cells;
  double worst_squared = 0.0;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double a = i * scale;
      const double b = j * scale;
      Eigen::Vector3d difference = -patch.point(column + i, row + j);
      if (i + j <= cells) {
        difference += (1.0 - a - b) * north_west + a * north_east + b * south_west;
      } else {
        difference += (a + b - 1.0) * south_east + (1.0 - a) * south_west + (1.0 - b) * north_east;
      }
      worst_squared = std::max(worst_squared, difference.squaredNorm());
    }
  }
  return std::sqrt(worst_squared);
}

}  // namespace

std::size_t GroundPatches::Hash::operator()(const TileId& id) const {
  std::uint64_t h = static_cast<std::uint32_t>(id.col);
  h = (h << 32U) ^ static_cast<std::uint32_t>(id.row) ^
      (static_cast<std::uint64_t>(id.level) << 58U);
  h *= 0x9E3779B97F4A7C15ULL;
  return h ^ (h >> 29U);
}

GroundPatches::GroundPatches(std::shared_ptr<const terrain::TileSource> tiles)
    : tiles_(std::move(tiles)) {}

TileId GroundPatches::tile_of(const TileId& id) {
  if (id.level >= 0) return id;
  return {0, id.col >> -id.level, id.row >> -id.level};
}

bool GroundPatches::above_imagery(const TileId& id) const {
  return id.level >= tiles_->grid().levels && id.col == 0 && id.row == 0;
}

GroundPatches::LatticePoint GroundPatches::lattice_point(const TileId& id, int column, int row) {
  const int scale = 1 << (id.level - kFinestPatchLevel);
  return {(id.col * kPatchCells + column) * scale, (id.row * kPatchCells + row) * scale};
}

Eigen::Vector3d GroundPatches::ground_point(const LatticePoint& at) const {
  const terrain::TileGrid& grid = tiles_->grid();
  const double step_m =
      std::ldexp(terrain::kTileTexels * grid.texel_m, kFinestPatchLevel - kLog2PatchCells);
  return tiles_->world_from_map(grid.left_x_m + at[0] * step_m, grid.top_y_m - at[1] * step_m);
}

TileCoverage GroundPatches::coverage_of(const TileId& id) const {
  if (id.level >= tiles_->grid().levels) {
    return above_imagery(id) ? TileCoverage::kPartial : TileCoverage::kNone;
  }
  return tiles_->coverage(tile_of(id));
}

GroundPatch& GroundPatches::outline(const TileId& id) {
  const auto [entry, is_new] = patches_.try_emplace(id);
  GroundPatch& patch = entry->second;
  patch.last_use = view_;
  if (!is_new) return patch;
  patch.id = id;
  patch.size_map_m = std::ldexp(terrain::kTileTexels * tiles_->grid().texel_m, id.level);
  patch.coverage = coverage_of(id);
  constexpr int kStep = kPatchCells / kOutlineCells;
  for (int row = 0; row <= kOutlineCells; ++row) {
    for (int column = 0; column <= kOutlineCells; ++column) {
      const Eigen::Vector3d point = ground_point(lattice_point(id, column * kStep, row * kStep));
      patch.outline[row * (kOutlineCells + 1) + column] = point;
      patch.bounds.extend(point);
    }
  }
  // Room for the relief between the outline's points: for large patches the whole range of
  // heights, for small ones a share of what the outline shows.
  const Eigen::Vector2d range_m = tiles_->height_range_m();
  const double relief_m = range_m.y() - range_m.x();
  const double seen_m = patch.bounds.sizes().z();
  const double margin_m = std::min(relief_m, std::max(0.5 * seen_m, 0.25 * patch.size_map_m)) +
                          0.5 + patch.size_map_m * patch.size_map_m / (4.0 * kEarthRadiusM);
  patch.bounds.min().z() -= margin_m;
  patch.bounds.max().z() += margin_m;
  return patch;
}

void GroundPatches::sample(GroundPatch& patch) const {
  if (!patch.points.empty()) return;
  patch.points.reserve((kPatchCells + 1) * (kPatchCells + 1));
  for (int row = 0; row <= kPatchCells; ++row) {
    for (int column = 0; column <= kPatchCells; ++column) {
      patch.points.push_back(ground_point(lattice_point(patch.id, column, row)));
    }
  }
  for (int t = 1; t <= kLog2PatchCells; ++t) {
    const int cells = 1 << t;
    for (int row = 0; row < kPatchCells; row += cells) {
      for (int column = 0; column < kPatchCells; column += cells) {
        patch.square_error_m[t].push_back(
            static_cast<float>(square_error_m(patch, column, row, cells)));
      }
    }
  }
}

void GroundPatches::end_view() {
  ++view_;
  if (patches_.size() <= kMaxPatches) return;
  std::vector<std::uint64_t> uses;
  uses.reserve(patches_.size());
  for (const auto& [id, patch] : patches_) uses.push_back(patch.last_use);
  const auto middle = uses.begin() + static_cast<std::ptrdiff_t>(uses.size() / 2);
  std::nth_element(uses.begin(), middle, uses.end());
  const std::uint64_t oldest_kept = *middle;
  std::erase_if(patches_, [&](const auto& entry) { return entry.second.last_use < oldest_kept; });
}

}  // namespace overfly::renderer
