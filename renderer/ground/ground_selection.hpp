// Selects the patches of ground that a view shows, their mesh resolution and the tiles that provide
// their texels.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "renderer/ground/ground_patch.hpp"
#include "renderer/ground/view.hpp"

namespace overfly::renderer {

struct MeshLimits {
  double max_edge_px = 64.0;  ///< longest side of a mesh square in the image
  /// Largest displacement in the image by the mesh's deviation from the ground; the mean is a fifth
  /// of it.
  double max_error_px = 0.08;
};

/// A sampled patch that the view shows, and its magnification in the image at the points of its
/// outline; 0 at points of invisible parts.
struct GroundLeaf {
  const GroundPatch* patch = nullptr;
  terrain::TileId texture;               ///< tile of level >= 0 that covers the patch
  bool textured = false;                 ///< false: no imagery here
  std::array<float, 25> px_per_m_up{};   ///< image motion of a vertical displacement
  std::array<float, 25> px_per_map_m{};  ///< image length of a step on the map
};

/// Called for each patch that the selection divides: its outline contains the new corners of its
/// parts.
using OnDivided = std::function<void(const GroundPatch&)>;

/// Selects the patches of a view as coarse as the image allows (a texel of the patch's tile is
/// nowhere larger than a pixel's footprint, except at level 0), up to the horizon.
/// Method: quadtree over the tile grid; a pure function of the view.
/// Cost: O(visited patches); new ones are sampled from the tile source.
[[nodiscard]] std::vector<GroundLeaf> select_ground(GroundPatches& patches,
                                                    const View& view,
                                                    const MeshLimits& limits,
                                                    const OnDivided& on_divided);

}  // namespace overfly::renderer
