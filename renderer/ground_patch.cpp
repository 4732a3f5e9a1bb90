#include "renderer/ground_patch.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::renderer {

using terrain::TileCoverage;
using terrain::TileId;

namespace {

constexpr double kEarthRadiusM = 6371000.0;
constexpr std::size_t kMaxPatches = 6000;  // some 60 MB when a quarter of them is sampled

/// Point of the mesh of 2^m cells above fine column i and row j: linear in the triangles that
/// `append_cell` of ground_mesh.cpp draws (diagonal from the north-east to the south-west).
Eigen::Vector3d mesh_point(const GroundPatch& patch, int log2_cells, int i, int j) {
  const int step = kPatchCells >> log2_cells;
  const int i0 = std::min(i / step * step, kPatchCells - step);
  const int j0 = std::min(j / step * step, kPatchCells - step);
  const double a = static_cast<double>(i - i0) / step;
  const double b = static_cast<double>(j - j0) / step;
  const Eigen::Vector3d& north_east = patch.point(i0 + step, j0);
  const Eigen::Vector3d& south_west = patch.point(i0, j0 + step);
  if (a + b <= 1.0) {
    const Eigen::Vector3d& corner = patch.point(i0, j0);
    return corner + a * (north_east - corner) + b * (south_west - corner);
  }
  const Eigen::Vector3d& corner = patch.point(i0 + step, j0 + step);
  return corner + (1.0 - a) * (south_west - corner) + (1.0 - b) * (north_east - corner);
}

double mesh_error_m(const GroundPatch& patch, int log2_cells) {
  double worst_squared = 0.0;
  for (int j = 0; j <= kPatchCells; ++j) {
    for (int i = 0; i <= kPatchCells; ++i) {
      const Eigen::Vector3d difference = patch.point(i, j) - mesh_point(patch, log2_cells, i, j);
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

Eigen::Vector3d GroundPatches::ground_point(const TileId& id, int column, int row) const {
  // Counted in whole steps of the finest patch, so that patches of any level that share a point
  // get the same bits for it: the mesh has no gaps.
  const terrain::TileGrid& grid = tiles_->grid();
  const double step_m =
      std::ldexp(terrain::kTileTexels * grid.texel_m, kFinestPatchLevel - kLog2PatchCells);
  const std::int64_t scale = std::int64_t{1} << (id.level - kFinestPatchLevel);
  const std::int64_t x = (static_cast<std::int64_t>(id.col) * kPatchCells + column) * scale;
  const std::int64_t y = (static_cast<std::int64_t>(id.row) * kPatchCells + row) * scale;
  return tiles_->world_from_map(grid.left_x_m + static_cast<double>(x) * step_m,
                                grid.top_y_m - static_cast<double>(y) * step_m);
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
      const Eigen::Vector3d point = ground_point(id, column * kStep, row * kStep);
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
      patch.points.push_back(ground_point(patch.id, column, row));
    }
  }
  for (int m = 0; m < kLog2PatchCells; ++m) patch.error_m[m] = mesh_error_m(patch, m);
  // Halving the cells divides the error of a smooth surface by four, of a kinked one by two.
  patch.error_m[kLog2PatchCells] = 0.5 * patch.error_m[kLog2PatchCells - 1];
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
