#include "renderer/ground_stitching.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace overfly::renderer {

using terrain::TileId;

namespace {

/// log2 of a leaf's cell size, in units of a patch of level 0.
int cell_exponent(const GroundLeaf& leaf) { return leaf.patch->id.level - leaf.log2_cells; }

/// For each leaf and side the leaf of the same or a coarser level beyond it; null where the
/// neighbours are finer or not drawn.
std::vector<std::array<GroundLeaf*, 4>> find_neighbours(std::vector<GroundLeaf>& leaves) {
  std::map<TileId, GroundLeaf*> by_id;
  int coarsest = kFinestPatchLevel;
  for (GroundLeaf& leaf : leaves) {
    by_id.emplace(leaf.patch->id, &leaf);
    coarsest = std::max(coarsest, leaf.patch->id.level);
  }
  constexpr std::array<std::array<int, 2>, 4> kStep{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  std::vector<std::array<GroundLeaf*, 4>> neighbours(leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const TileId& id = leaves[i].patch->id;
    for (int side = 0; side < 4; ++side) {
      TileId beyond{id.level, id.col + kStep[side][0], id.row + kStep[side][1]};
      for (; beyond.level <= coarsest; ++beyond.level, beyond.col >>= 1, beyond.row >>= 1) {
        const auto found = by_id.find(beyond);
        if (found == by_id.end()) continue;
        neighbours[i][side] = found->second;
        break;
      }
    }
  }
  return neighbours;
}

}  // namespace

void stitch_borders(std::vector<GroundLeaf>& leaves) {
  std::sort(leaves.begin(), leaves.end(), [](const GroundLeaf& a, const GroundLeaf& b) {
    return b.patch->id < a.patch->id;  // coarse levels first
  });
  const auto neighbours = find_neighbours(leaves);

  // A cell is no longer than the side of a finer neighbour, so that the latter's corners are
  // points of both.
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    for (GroundLeaf* coarse : neighbours[i]) {
      if (coarse == nullptr) continue;
      const int needed = coarse->patch->id.level - leaves[i].patch->id.level;
      coarse->log2_cells = std::clamp(needed, coarse->log2_cells, kLog2PatchCells);
    }
  }
  // The cells of a finer patch are no longer than those of its coarser neighbours: coarse first.
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    GroundLeaf& leaf = leaves[i];
    for (const GroundLeaf* coarse : neighbours[i]) {
      if (coarse == nullptr || coarse->patch->id.level == leaf.patch->id.level) continue;
      const int needed = leaf.patch->id.level - cell_exponent(*coarse);
      leaf.log2_cells = std::clamp(needed, leaf.log2_cells, kLog2PatchCells);
    }
  }
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    for (int side = 0; side < 4; ++side) {
      const GroundLeaf* other = neighbours[i][side];
      const int ratio = other == nullptr ? 0 : cell_exponent(*other) - cell_exponent(leaves[i]);
      leaves[i].log2_border_ratio[side] = std::clamp(ratio, 0, leaves[i].log2_cells);
    }
  }
}

}  // namespace overfly::renderer
