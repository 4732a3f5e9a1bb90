#include "renderer/ground/ground_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "renderer/ground/ground_reach.hpp"

namespace overfly::renderer {

using terrain::TileCoverage;
using terrain::TileId;

namespace {

/// The texel density is computed at the outline's points; between them it may be lower by this
/// factor.
constexpr double kDensityMargin = 0.9;
/// A patch whose elevation is finer than its 32 cells is split until its cells are no longer than
/// this in the image.
constexpr double kFinestCellPx = 2.0;

/// The appearance of a patch in the image.
struct Appearance {
  GroundLeaf leaf;
  double texels_per_px_min = std::numeric_limits<double>::infinity();  ///< of level 0
};

class Selector {
 public:
  Selector(GroundPatches& patches,
           const View& view,
           const MeshLimits& limits,
           const OnDivided& on_divided)
      : patches_(patches),
        view_(view),
        limits_(limits),
        on_divided_(on_divided),
        side_normals_(view.side_normals_world()),
        up_camera_(view.R_camera_world.col(2)) {}

  std::vector<GroundLeaf> run() {
    const terrain::TileSource& tiles = patches_.tiles();
    const terrain::TileGrid& grid = tiles.grid();
    const double reach_m = reach();
    int level = grid.levels;
    while (level < 24 && grid.tile_m(level) < reach_m) ++level;
    const Eigen::Vector2d map =
        tiles.map_from_world(view_.position_world.x(), view_.position_world.y());
    if (!map.allFinite()) return {};  // outside the range of the map's projection
    const double size_m = grid.tile_m(level);
    const int column = static_cast<int>(std::floor((map.x() - grid.left_x_m) / size_m));
    const int row = static_cast<int>(std::floor((grid.top_y_m - map.y()) / size_m));
    for (int dr = -1; dr <= 1; ++dr) {
      for (int dc = -1; dc <= 1; ++dc) visit({level, column + dc, row + dr});
    }
    while (!candidates_.empty()) keep_or_divide(std::exchange(candidates_, {}));
    return std::move(leaves_);
  }

 private:
  struct Candidate {
    GroundPatch* patch = nullptr;
    GroundLeaf leaf;
  };

  /// Distance to the farthest visible ground: the camera's horizon plus that of the highest ground.
  [[nodiscard]] double reach() const {
    const Eigen::Vector2d range_m = patches_.tiles().height_range_m();
    const double camera_m =
        patches_.tiles().frame().geodetic_from_world(view_.position_world).alt_ellipsoid_m;
    const double above_m = std::max(camera_m - range_m.x(), 2.0);
    const double relief_m = std::max(range_m.y() - range_m.x(), 0.0);
    return horizon_m(above_m, relief_m);
  }

  [[nodiscard]] bool outside(const Eigen::AlignedBox3d& box) const {
    const Eigen::Vector3d centre = box.center() - view_.position_world;
    const Eigen::Vector3d half = 0.5 * box.sizes();
    return std::any_of(side_normals_.begin(), side_normals_.end(), [&](const auto& normal) {
      return normal.dot(centre) + normal.cwiseAbs().dot(half) < 0.0;
    });
  }

  void visit(const TileId& id) {
    GroundPatch& patch = patches_.outline(id);
    if (outside(patch.bounds)) return;
    Appearance appearance = measure(patch);
    if (id.level > kFinestPatchLevel && needs_finer_texels(patch, appearance)) {
      divide(patch, [this](const TileId& child) { visit(child); });
      return;
    }
    appearance.leaf.textured = patch.coverage != TileCoverage::kNone;
    appearance.leaf.texture = GroundPatches::tile_of(id);
    candidates_.push_back({&patch, appearance.leaf});
  }

  /// Keeps patches, or divides those further whose relief is finer than their cells.
  void keep_or_divide(const std::vector<Candidate>& candidates) {
    std::vector<GroundPatch*> patches;
    patches.reserve(candidates.size());
    for (const Candidate& candidate : candidates) patches.push_back(candidate.patch);
    patches_.sample(patches);
    for (const auto& [patch, leaf] : candidates) {
      if (!leaf.textured || patch->id.level <= kFinestPatchLevel || !has_finer_relief(leaf)) {
        leaves_.push_back(leaf);
        continue;
      }
      divide(*patch, [&](const TileId& id) {
        GroundPatch& child = patches_.outline(id);
        if (outside(child.bounds)) return;
        GroundLeaf child_leaf = measure(child).leaf;
        child_leaf.texture = leaf.texture;
        child_leaf.textured = leaf.textured;
        candidates_.push_back({&child, child_leaf});
      });
    }
  }

  /// True if the ground between the points of a patch visibly deviates from its finest mesh.
  [[nodiscard]] bool has_finer_relief(const GroundLeaf& leaf) const {
    const double cell_m = leaf.patch->size_map_m / kPatchCells;
    constexpr int kCells = kPatchCells / kOutlineCells;
    for (int row = 0; row < kPatchCells; ++row) {
      for (int column = 0; column < kPatchCells; ++column) {
        const int corner = row / kCells * kOutlinePoints + column / kCells;
        if (cell_m * largest_of(leaf.px_per_map_m, corner) < kFinestCellPx) continue;
        const float error_m = leaf.patch->square_error(0, column, row);
        if (error_m * largest_of(leaf.px_per_m_up, corner) > limits_.max_error_px) return true;
      }
    }
    return false;
  }

  /// The largest value at the corners of the outline's cell with the given north-west corner.
  [[nodiscard]] static float largest_of(const std::array<float, 25>& values, int corner) {
    return std::max({values[corner],
                     values[corner + 1],
                     values[corner + kOutlinePoints],
                     values[corner + kOutlinePoints + 1]});
  }

  template <typename Visit>
  void divide(const GroundPatch& patch, const Visit& visit) {
    on_divided_(patch);
    const TileId id = patch.id;
    for (int row = 0; row < 2; ++row) {
      for (int column = 0; column < 2; ++column) {
        visit(TileId{id.level - 1, 2 * id.col + column, 2 * id.row + row});
      }
    }
  }

  [[nodiscard]] bool needs_finer_texels(const GroundPatch& patch,
                                        const Appearance& appearance) const {
    if (patches_.above_imagery(patch.id)) return true;
    // So close that the outline's points do not represent the ground between them.
    const double distance_m = patch.bounds.exteriorDistance(view_.position_world);
    if (patch.bounds.sizes().head<2>().maxCoeff() / kOutlineCells > 0.5 * distance_m) return true;
    return std::ldexp(1.0, patch.id.level) > kDensityMargin * appearance.texels_per_px_min;
  }

  [[nodiscard]] Appearance measure(const GroundPatch& patch) const;
  void measure_point(int column, int row, double step_m, Appearance& appearance) const;

  static constexpr int kOutlinePoints = kOutlineCells + 1;

  GroundPatches& patches_;
  const View& view_;
  MeshLimits limits_;
  const OnDivided& on_divided_;
  std::array<Eigen::Vector3d, 4> side_normals_;
  Eigen::Vector3d up_camera_;
  std::vector<Candidate> candidates_;  // seen, to be sampled
  std::vector<GroundLeaf> leaves_;
  mutable std::array<Eigen::Vector3d, 25> outline_camera_;
};

Appearance Selector::measure(const GroundPatch& patch) const {
  std::array<unsigned, 25> codes{};
  for (std::size_t i = 0; i < outline_camera_.size(); ++i) {
    outline_camera_[i] = view_.camera_from_world(patch.outline[i]);
    codes[i] = view_.outcode(outline_camera_[i]);
  }
  std::array<bool, 25> counts{};
  bool any = false;
  for (int row = 0; row < kOutlineCells; ++row) {
    for (int column = 0; column < kOutlineCells; ++column) {
      const int a = row * kOutlinePoints + column;
      const int b = a + kOutlinePoints;
      if ((codes[a] & codes[a + 1] & codes[b] & codes[b + 1]) != 0U) continue;
      counts[a] = counts[a + 1] = counts[b] = counts[b + 1] = any = true;
    }
  }
  Appearance appearance;
  appearance.leaf.patch = &patch;
  const double step_m = patch.size_map_m / kOutlineCells;
  for (int i = 0; i < kOutlinePoints * kOutlinePoints; ++i) {
    if ((!counts[i] && any) || outline_camera_[i].z() <= 1e-3) continue;
    measure_point(i % kOutlinePoints, i / kOutlinePoints, step_m, appearance);
  }
  return appearance;
}

void Selector::measure_point(int column, int row, double step_m, Appearance& appearance) const {
  const auto at = [&](int c, int r) -> const Eigen::Vector3d& {
    return outline_camera_[r * kOutlinePoints + c];
  };
  const int west = std::max(column - 1, 0);
  const int east = std::min(column + 1, kOutlineCells);
  const int north = std::max(row - 1, 0);
  const int south = std::min(row + 1, kOutlineCells);
  const Eigen::Vector3d& p = at(column, row);
  const Eigen::Vector2d a =
      view_.pixel_rate(p, (at(east, row) - at(west, row)) / (step_m * (east - west)));
  const Eigen::Vector2d b =
      view_.pixel_rate(p, (at(column, south) - at(column, north)) / (step_m * (south - north)));
  // The inverse of [a b] maps a pixel step to map metres; its largest element is the footprint by
  // which the sampler chooses the mip level.
  const double determinant = std::abs(a.x() * b.y() - a.y() * b.x());
  const double largest = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  if (determinant > 1e-12 * largest * largest) {
    const double texels = largest / (determinant * patches_.tiles().grid().texel_m);
    appearance.texels_per_px_min = std::min(appearance.texels_per_px_min, texels);
  }
  const int index = row * kOutlinePoints + column;
  appearance.leaf.px_per_map_m[index] = static_cast<float>(std::max(a.norm(), b.norm()));
  appearance.leaf.px_per_m_up[index] = static_cast<float>(view_.pixel_rate(p, up_camera_).norm());
}

}  // namespace

std::vector<GroundLeaf> select_ground(GroundPatches& patches,
                                      const View& view,
                                      const MeshLimits& limits,
                                      const OnDivided& on_divided) {
  return Selector(patches, view, limits, on_divided).run();
}

}  // namespace overfly::renderer
