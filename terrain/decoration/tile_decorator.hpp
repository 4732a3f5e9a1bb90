// Base class of layers that modify other tiles.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "terrain/tile_source.hpp"

namespace overfly::terrain {

/// Forwards all calls; derived classes override what they change.
class TileDecorator : public TileSource {
 public:
  explicit TileDecorator(std::shared_ptr<const TileSource> base) : base_(std::move(base)) {}

  [[nodiscard]] const TileGrid& grid() const override { return base_->grid(); }
  [[nodiscard]] double real_texel_m() const override { return base_->real_texel_m(); }
  [[nodiscard]] TileCoverage coverage(const TileId& id) const override {
    return base_->coverage(id);
  }
  [[nodiscard]] Eigen::Vector3d world_from_map(double x_map_m, double y_map_m) const override {
    return base_->world_from_map(x_map_m, y_map_m);
  }
  [[nodiscard]] Eigen::Vector3d coarse_world_from_map(double x_map_m,
                                                      double y_map_m,
                                                      double spacing_m) const override {
    return base_->coarse_world_from_map(x_map_m, y_map_m, spacing_m);
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> coarse_world_at(
      std::span<const Eigen::Vector2d> places_map_m, double spacing_m) const override {
    return base_->coarse_world_at(places_map_m, spacing_m);
  }
  [[nodiscard]] Eigen::Vector2d map_from_world(double east_m, double north_m) const override {
    return base_->map_from_world(east_m, north_m);
  }
  [[nodiscard]] double ground_up_m(double east_m, double north_m) const override {
    return base_->ground_up_m(east_m, north_m);
  }
  [[nodiscard]] bool has_imagery(double x_map_m, double y_map_m) const override {
    return base_->has_imagery(x_map_m, y_map_m);
  }
  [[nodiscard]] const LocalFrame& frame() const override { return base_->frame(); }
  [[nodiscard]] Eigen::Vector2d height_range_m() const override { return base_->height_range_m(); }
  [[nodiscard]] std::string attribution() const override { return base_->attribution(); }
  [[nodiscard]] Status status() const override { return base_->status(); }

 protected:
  [[nodiscard]] const TileSource& base() const { return *base_; }

 private:
  [[nodiscard]] Result<Tile> read_tile(const TileId& id,
                                       const Cancelled& cancelled) const override {
    return base_->tile(id, cancelled);
  }

  std::shared_ptr<const TileSource> base_;
};

}  // namespace overfly::terrain
