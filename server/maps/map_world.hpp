// An opened world as the source of a web map: its place on the map, and its tiles in memory.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "server/files/recent_values.hpp"
#include "server/worlds/scenario_world.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::server {

/// A rectangle of the web Mercator square.
struct MercatorBox {
  Eigen::Vector2d low{0.0, 0.0};   ///< west, north; x is continuous across 180 deg
  Eigen::Vector2d high{0.0, 0.0};  ///< east, south
};

/// Thread-safe.
class MapWorld {
 public:
  /// Reads heights around the imagery.
  /// @param key  of the scenario's world, see world_key
  MapWorld(std::shared_ptr<const OpenedWorld> opened, const std::string& key);

  [[nodiscard]] const terrain::World& world() const { return opened_->world; }
  [[nodiscard]] const terrain::TileSource& tiles() const { return *opened_->world.tiles; }
  /// All imagery, with a margin.
  [[nodiscard]] const MercatorBox& box() const { return box_; }
  /// The zoom level whose pixels are as fine as the texels, or finer by less than a factor of 2.
  [[nodiscard]] int finest_zoom() const { return finest_zoom_; }
  /// Another one for every change of the files and of the world's fields in the scenario.
  [[nodiscard]] const std::string& version() const { return version_; }
  /// A tile of the world; those used last are kept. Errors: as terrain::TileSource::tile.
  [[nodiscard]] Result<std::shared_ptr<const terrain::Tile>> tile(
      const terrain::TileId& id, const terrain::Cancelled& cancelled) const;
  [[nodiscard]] const std::shared_ptr<const OpenedWorld>& opened() const { return opened_; }

 private:
  /// 1.1 MB each.
  static constexpr std::size_t kKeptTiles = 48;

  std::shared_ptr<const OpenedWorld> opened_;
  MercatorBox box_;
  int finest_zoom_ = 0;
  std::string version_;
  mutable RecentValues<terrain::Tile> kept_{kKeptTiles};
};

}  // namespace overfly::server
