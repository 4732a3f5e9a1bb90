// Casts the rays of one row of cells and builds blocks from the hits.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "renderer/raycast/cache_line.hpp"
#include "renderer/raycast/ground/ground_caster.hpp"
#include "renderer/raycast/ground/ray_grid.hpp"
#include "renderer/raycast/ground/shutter.hpp"
#include "renderer/raycast/paint/blocks.hpp"

namespace overfly::renderer::raycast {

/// Limit of the displacement in the image by interpolation between the rays of a block [px].
inline constexpr double kBlockErrorPx = 0.2;

/// The hit of one ray.
struct Node {
  Eigen::Vector2d ray{0.0, 0.0};             ///< camera frame, z = 1
  Eigen::Vector3d direction{0.0, 0.0, 1.0};  ///< the same in the world
  double drop = 0.0;                         ///< loss of height per length along the ray
  GroundHit hit;
  double inverse_depth = 0.0;  ///< [1 / m]; 0 = sky
  double u = 0.0, v = 0.0;     ///< texels of level 0
  double px_per_m = 0.0;       ///< displacement in the image per change of the ground's height
  double range_m = 0.0;
};

struct alignas(kCacheLineBytes) NodeRow {
  std::vector<Node> nodes;
};

struct BlockSettings {
  const CameraRequest* request = nullptr;
  const RayGrid* rays = nullptr;
  const ShutterPoses* poses = nullptr;
  const GroundCaster* caster = nullptr;
  const terrain::TileSource* tiles = nullptr;
  /// Blocks for a depth image: heights count from whichever side they are seen.
  bool depth_only = false;
};

/// d(texel of level 0) / d(pixel) on the ground's tangent plane at a hit.
/// @param ray  of the hit, camera frame, z = 1
/// @param step_x,  step_y  change of the ray from pixel to pixel
[[nodiscard]] Eigen::Matrix2d texel_jacobian(const GroundHit& hit,
                                             const RowPose& pose,
                                             const Eigen::Vector2d& ray,
                                             const Eigen::Vector2d& step_x,
                                             const Eigen::Vector2d& step_y);

/// Casts the rays of a row of nodes. @param row  in [0, rays.rows()]
void cast_row(const BlockSettings& settings, int row, std::vector<Node>& nodes);

/// Builds the blocks of the cells between two rows of nodes. @param row  of the upper nodes
void build_band(const BlockSettings& settings,
                int row,
                const std::vector<Node>& upper,
                const std::vector<Node>& lower,
                Band& band);

}  // namespace overfly::renderer::raycast
