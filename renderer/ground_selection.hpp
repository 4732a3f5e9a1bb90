// Which patches of ground a view shows, how fine each is meshed, and from which tile it takes
// its texels.
#pragma once

#include <array>
#include <vector>

#include "renderer/ground_patch.hpp"
#include "renderer/view.hpp"

namespace overfly::renderer {

struct MeshLimits {
  double max_edge_px = 64.0;   ///< longest edge of a mesh cell in the image
  double max_error_px = 0.25;  ///< displacement by the mesh's deviation from the ground
};

/// The sides of a patch, as indices.
enum PatchSide { kWest = 0, kEast = 1, kNorth = 2, kSouth = 3 };

struct GroundLeaf {
  const GroundPatch* patch = nullptr;
  terrain::TileId texture;  ///< tile of level >= 0 that covers the patch
  bool textured = false;    ///< false: no imagery here
  int log2_cells = 0;       ///< the mesh has 2^log2_cells cells a side
  /// log2 of how many of its own cells one cell of each border spans: a border is as coarse as
  /// the coarser of its two patches, so that no gap opens between them.
  std::array<int, 4> log2_border_ratio{};
};

/// Selects the patches of a view: as coarse as the image allows (the texel of a patch's tile is
/// nowhere larger than a pixel's footprint, except at level 0), to the horizon.
/// Method: quadtree over the tile grid; a pure function of the view.
/// Cost: O(visited patches); new ones are sampled from the tile source.
[[nodiscard]] std::vector<GroundLeaf> select_ground(GroundPatches& patches,
                                                    const View& view,
                                                    const MeshLimits& limits);

}  // namespace overfly::renderer
