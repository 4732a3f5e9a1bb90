// The ground of a view as a quadtree of height tiles, as fine as the image can show.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <vector>

#include "renderer/raycast/ground/height_tile.hpp"

namespace overfly::renderer::raycast {

/// Limit of the displacement in the image by the approximation of the ground by height tiles [px].
inline constexpr double kSurfaceErrorPx = 0.05;
/// Maximum size of the height tiles' cells in the image, so that a hill on a plain cannot be missed
/// between their posts.
inline constexpr double kMaxCellPx = 16.0;
/// Minimum useful size of a cell.
inline constexpr double kMinCellPx = 1.0;

/// Approximate bounds of all origins and directions of a view's rays.
struct ViewSweep {
  /// Eigen's own default leaves vectors without a value.
  inline static const std::array<Eigen::Vector3d, 4> kNoVectors{Eigen::Vector3d::Zero(),
                                                                Eigen::Vector3d::Zero(),
                                                                Eigen::Vector3d::Zero(),
                                                                Eigen::Vector3d::Zero()};

  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world frame [m]
  double slack_m = 0.0;  ///< the rays begin within this distance of the position
  /// Inward normals of planes through the position that contain all rays (unit length); zero if
  /// there are none.
  std::array<Eigen::Vector3d, 4> side_normals = kNoVectors;
  /// Along the edges between the planes; zero length if there are none.
  std::array<Eigen::Vector3d, 4> corners = kNoVectors;
  bool bounded = false;     ///< whether corners are known
  double px_per_rad = 1.0;  ///< at the sharpest place of the image
};

/// A node of the quadtree over the visible ground.
struct GroundNode {
  const HeightTile* tile = nullptr;
  double east_m = 0.0, north_m = 0.0, side_m = 0.0;
  double highest_m = -1e9;  ///< up coordinate of the highest ground drawn below this node
  std::int32_t parent = -1;
  /// By (north half) * 2 + (east half); -1 = out of view; all -1 and `leaf` = draw the tile itself.
  std::array<std::int32_t, 4> children{-1, -1, -1, -1};
  bool leaf = false;

  [[nodiscard]] bool holds(double at_east_m, double at_north_m) const {
    return at_east_m >= east_m && at_east_m < east_m + side_m && at_north_m >= north_m &&
           at_north_m < north_m + side_m;
  }
};

struct GroundTree {
  std::vector<GroundNode> nodes;
  /// 3 x 3 squares around the camera; -1 = out of view.
  std::array<std::int32_t, 9> roots{};
  double east_m = 0.0, north_m = 0.0, side_m = 0.0;  ///< of the south-western root
  double highest_m = -1e9;
  double steepest = 0.0;  ///< bound of the slope anywhere
};

inline constexpr std::size_t kMaxHeightTiles = 3000;  ///< some 75 MB

/// Samples height tiles and caches the most recently used ones. The cache does not affect values.
class HeightField {
 public:
  /// @param max_tiles  in the cache; those of the view selected last are always kept
  explicit HeightField(std::shared_ptr<const terrain::TileSource> tiles,
                       std::size_t max_tiles = kMaxHeightTiles);

  /// The ground of a view. Valid until the next call.
  [[nodiscard]] const GroundTree& select(const ViewSweep& view);
  /// Samples one of the missing tiles that a later view will need.
  void prepare(const ViewSweep& later);
  [[nodiscard]] const TexelMap& map() const { return map_; }
  [[nodiscard]] std::size_t held_tiles() const { return kept_.size(); }

 private:
  using Order = std::list<HeightTileId>;  // last used first
  struct Kept {
    std::unique_ptr<HeightTile> tile;
    Order::iterator place;
  };
  const HeightTile& tile(const HeightTileId& id);
  std::int32_t visit(const HeightTileId& id, std::int32_t parent, const ViewSweep& view);
  /// The south-western of the 3 x 3 squares around a view.
  [[nodiscard]] HeightTileId first_root(const ViewSweep& view) const;
  /// True if a tile was sampled.
  bool prepare_below(const HeightTileId& id, const ViewSweep& later);
  [[nodiscard]] bool outside(const HeightTile& tile, const ViewSweep& view) const;
  [[nodiscard]] bool fine_enough(const HeightTile& tile, const ViewSweep& view) const;
  [[nodiscard]] double reach_m(const ViewSweep& view) const;
  /// Evicts the least recently used tiles one at a time, to spread the cost over frames.
  void forget_old();

  std::shared_ptr<const terrain::TileSource> tiles_;
  TexelMap map_;
  std::size_t max_tiles_;
  std::map<HeightTileId, Kept> kept_;
  Order order_;
  std::uint64_t view_ = 0;
  GroundTree tree_;
};

}  // namespace overfly::renderer::raycast
