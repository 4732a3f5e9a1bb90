// Square patches of ground, sampled in the world frame, of which the mesh is composed.
//
// Patches use the addressing of terrain tiles and may also be finer than level 0: a patch of level
// L spans kTileTexels * texel_m * 2^L map units, L in [kFinestPatchLevel, ...].
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "terrain/tile_source.hpp"

namespace overfly::renderer {

class WorkerPool;

inline constexpr int kFinestPatchLevel = -6;
inline constexpr int kLog2PatchCells = 5;
inline constexpr int kPatchCells = 1 << kLog2PatchCells;  ///< maximum number of cells per side
inline constexpr int kOutlineCells = 4;                   ///< cells of the coarse outline

/// Written once, by the first thread that needs it; then read by all threads.
struct GroundPatch {
  terrain::TileId id;
  double size_map_m = 0.0;
  /// (kOutlineCells + 1)^2 points of the ground, world frame; rows from north to south.
  std::array<Eigen::Vector3d, 25> outline;
  Eigen::AlignedBox3d bounds;  ///< contains the ground of the patch, world frame
  terrain::TileCoverage coverage = terrain::TileCoverage::kNone;

  /// (kPatchCells + 1)^2 points of the ground; empty until sampled.
  std::vector<Eigen::Vector3d> points;
  /// Largest distance between the ground in a square of 2^t cells and the square's two triangles
  /// [m], by t and the square's place. The ground is sampled there at points half a cell apart.
  std::array<std::vector<float>, kLog2PatchCells + 1> square_error_m;

  std::once_flag outlined, sampled;
  std::atomic<bool> is_sampled = false;

  [[nodiscard]] const Eigen::Vector3d& point(int column, int row) const {
    return points[static_cast<std::size_t>(row) * (kPatchCells + 1) + column];
  }
  /// @param t  log2 of the square's cells per side
  [[nodiscard]] float square_error(int t, int column, int row) const {
    return square_error_m[t][static_cast<std::size_t>(row) * (kPatchCells >> t) + column];
  }
};

/// A ground point by its place in the cell lattice of the finest patches, relative to the grid's
/// corner, to the east and to the south.
using LatticePoint = std::array<std::int32_t, 2>;
[[nodiscard]] LatticePoint lattice_point(const terrain::TileId& id, int column, int row);

/// A cache of patches shared by several threads, within a budget. A patch depends only on its
/// address: elevation is averaged to half a cell of its lattice, so that distant ground needs
/// little memory and near ground has the full resolution of the elevation.
class GroundPatchStore {
 public:
  explicit GroundPatchStore(std::shared_ptr<const terrain::TileSource> tiles,
                            std::size_t budget_bytes = std::size_t{96} << 20U);

  /// The patch with its outline.
  [[nodiscard]] std::shared_ptr<GroundPatch> outline(const terrain::TileId& id);
  /// Fills points and square_error_m.
  void sample(GroundPatch& patch);

  [[nodiscard]] const terrain::TileSource& tiles() const { return *tiles_; }
  [[nodiscard]] std::size_t held_bytes() const;
  /// True if patches of another view fit without evicting any.
  [[nodiscard]] bool has_room() const { return held_bytes() < budget_bytes_ / 5 * 4; }

 private:
  struct Hash {
    std::size_t operator()(const terrain::TileId& id) const;
  };
  struct Entry {
    std::shared_ptr<GroundPatch> patch;
    std::size_t bytes = 0;
    std::list<terrain::TileId>::iterator place;
  };
  void make_outline(GroundPatch& patch) const;
  [[nodiscard]] terrain::TileCoverage coverage_of(const terrain::TileId& id) const;
  void add_bytes(const terrain::TileId& id, std::size_t bytes);

  std::shared_ptr<const terrain::TileSource> tiles_;
  std::size_t budget_bytes_;
  mutable std::mutex mutex_;
  std::unordered_map<terrain::TileId, Entry, Hash> patches_;
  std::list<terrain::TileId> order_;  // last used first
  std::size_t held_bytes_ = 0;
};

/// The patches of one view at a time, for one thread.
class GroundPatches {
 public:
  explicit GroundPatches(std::shared_ptr<const terrain::TileSource> tiles);
  /// @param workers  sample new patches together; null: the calling thread alone
  explicit GroundPatches(std::shared_ptr<GroundPatchStore> store, WorkerPool* workers = nullptr);

  /// The patch with its outline. References stay valid until end_view().
  GroundPatch& outline(const terrain::TileId& id);
  /// Samples those that are not sampled yet.
  void sample(std::span<GroundPatch* const> patches) const;
  void end_view() { in_use_.clear(); }

  [[nodiscard]] const terrain::TileSource& tiles() const { return store_->tiles(); }
  /// True if the patch, coarser than the coarsest tile, contains imagery.
  [[nodiscard]] bool above_imagery(const terrain::TileId& id) const;
  /// The tile that provides a patch's texels: itself, or its ancestor of level 0.
  [[nodiscard]] static terrain::TileId tile_of(const terrain::TileId& id);

 private:
  std::shared_ptr<GroundPatchStore> store_;
  WorkerPool* workers_;
  std::vector<std::shared_ptr<GroundPatch>> in_use_;
};

}  // namespace overfly::renderer
