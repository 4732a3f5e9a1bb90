// The ground of a view as triangles in the camera frame.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/ground/ground_selection.hpp"

namespace overfly::renderer {

struct GroundVertex {
  float x = 0.0F, y = 0.0F, z = 0.0F;  ///< camera frame [m]
  float u = 0.0F, v = 0.0F;            ///< texture coordinates in the tile with its border
};

/// Triangles with texels of one tile, or ground without imagery.
struct GroundBatch {
  bool textured = false;
  terrain::TileId texture;
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
};

struct GroundMesh {
  std::vector<GroundVertex> vertices;
  std::vector<std::uint32_t> indices;  ///< three per triangle
  std::vector<GroundBatch> batches;
  /// False if no triangle in the image faces away. A ray that meets the ground twice leaves it
  /// through a back face in between; without back faces nothing is hidden and no depth test is
  /// needed.
  bool needs_depth_test = false;
};

/// Builds the mesh of a view. Triangles outside the image or facing away (seen from below the
/// ground) are omitted.
[[nodiscard]] GroundMesh build_ground_mesh(GroundPatches& patches,
                                           const View& view,
                                           const MeshLimits& limits);

}  // namespace overfly::renderer
