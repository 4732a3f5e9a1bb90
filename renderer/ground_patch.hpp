// Squares of ground, sampled in the world frame: the pieces of which the mesh is made.
//
// Patches use the addressing of terrain tiles and may also be finer than level 0: a patch of
// level L spans kTileTexels * texel_m * 2^L map units, L in [kFinestPatchLevel, ...].
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "terrain/tile_source.hpp"

namespace overfly::renderer {

inline constexpr int kFinestPatchLevel = -6;
inline constexpr int kLog2PatchCells = 5;
inline constexpr int kPatchCells = 1 << kLog2PatchCells;  ///< cells along a side, at the finest
inline constexpr int kOutlineCells = 4;                   ///< cells of the coarse outline

struct GroundPatch {
  terrain::TileId id;
  double size_map_m = 0.0;
  /// (kOutlineCells + 1)^2 points of the ground, world frame; rows from north to south.
  std::array<Eigen::Vector3d, 25> outline;
  Eigen::AlignedBox3d bounds;  ///< holds the ground of the patch, world frame
  terrain::TileCoverage coverage = terrain::TileCoverage::kNone;

  /// (kPatchCells + 1)^2 points of the ground; empty until sampled.
  std::vector<Eigen::Vector3d> points;
  /// Largest distance between the sampled ground in a square of 2^t cells and the square's two
  /// triangles [m], by t and the square's place; nothing for t = 0.
  std::array<std::vector<float>, kLog2PatchCells + 1> square_error_m;

  std::uint64_t last_use = 0;

  [[nodiscard]] const Eigen::Vector3d& point(int column, int row) const {
    return points[static_cast<std::size_t>(row) * (kPatchCells + 1) + column];
  }
  /// @param t  log2 of the square's cells a side, >= 1
  [[nodiscard]] float square_error(int t, int column, int row) const {
    return square_error_m[t][static_cast<std::size_t>(row) * (kPatchCells >> t) + column];
  }
};

/// Samples patches from a tile source and keeps those used last.
class GroundPatches {
 public:
  explicit GroundPatches(std::shared_ptr<const terrain::TileSource> tiles);

  /// A ground point by its place in the lattice of the finest patches' cells, counted from the
  /// grid's corner to the east and to the south. Patches of any level that share a point get the
  /// same bits for it.
  using LatticePoint = std::array<std::int32_t, 2>;
  [[nodiscard]] static LatticePoint lattice_point(const terrain::TileId& id, int column, int row);

  /// The patch with its outline. References stay good until end_view().
  GroundPatch& outline(const terrain::TileId& id);
  /// Fills points and square_error_m.
  void sample(GroundPatch& patch) const;
  /// Forgets the patches used longest ago when there are many.
  void end_view();

  [[nodiscard]] const terrain::TileSource& tiles() const { return *tiles_; }
  /// True where the patch, coarser than the coarsest tile, holds some of the imagery.
  [[nodiscard]] bool above_imagery(const terrain::TileId& id) const;
  /// The tile whose texels cover a patch: itself, or its ancestor of level 0.
  [[nodiscard]] static terrain::TileId tile_of(const terrain::TileId& id);

 private:
  struct Hash {
    std::size_t operator()(const terrain::TileId& id) const;
  };
  [[nodiscard]] Eigen::Vector3d ground_point(const LatticePoint& at) const;
  [[nodiscard]] terrain::TileCoverage coverage_of(const terrain::TileId& id) const;

  std::shared_ptr<const terrain::TileSource> tiles_;
  std::unordered_map<terrain::TileId, GroundPatch, Hash> patches_;
  std::uint64_t view_ = 0;
};

}  // namespace overfly::renderer
