// Inside terrain only: the light at the nodes of a lattice over the ground.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "terrain/decoration/cloud_field.hpp"
#include "terrain/decoration/height_lattice.hpp"
#include "terrain/decoration/light.hpp"

namespace overfly::terrain {

/// Visible fraction of the sun's disc above a straight horizon.
/// @param above_rad  elevation of the disc's centre above the horizon
[[nodiscard]] double visible_disc(double above_rad);

/// A node's value depends only on its place, so that neighbouring tiles agree.
class LightField {
 public:
  LightField(std::shared_ptr<const TileSource> tiles,
             const LightOptions& options,
             double spacing_m);

  [[nodiscard]] double spacing_m(int lattice) const { return heights_.spacing_m(lattice); }

  /// Light relative to open flat ground, in [0, kMaxLight], at nodes [i, i + columns) x [j, j +
  /// rows) of a lattice (numbered as in HeightLattice).
  [[nodiscard]] ImageBuffer<float> nodes(int lattice, int i, int j, int columns, int rows) const;

 private:
  /// First-order approximation of the map around a place.
  struct Chart {
    Eigen::Matrix2d world_per_map;
    Eigen::Vector2d sunward_map;  ///< map metres per metre towards the sun, seen from above
  };
  [[nodiscard]] Chart chart(int lattice, int block_i, int block_j) const;
  [[nodiscard]] double sunlight(
      const Chart& chart, HeightLattice::Reader& heights, int lattice, int i, int j) const;
  [[nodiscard]] double horizon_rad(
      const Chart& chart, HeightLattice::Reader& heights, int lattice, int i, int j) const;

  std::shared_ptr<const TileSource> tiles_;
  LightOptions options_;
  Eigen::Vector3d sun_;
  HeightLattice heights_;
  CloudField clouds_;
  double highest_up_m_ = 0.0;
};

}  // namespace overfly::terrain
