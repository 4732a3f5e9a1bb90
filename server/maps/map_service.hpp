// Maps of worlds for clients: descriptions, tiles and heights of the ground.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/files/recent_values.hpp"
#include "server/maps/map_world.hpp"
#include "server/maps/mercator.hpp"
#include "server/runs/run_manager.hpp"

namespace overfly::server {

/// Points in a request for heights.
inline constexpr std::size_t kMaxHeightPoints = 2000;

/// An encoded picture.
struct MapTile {
  const char* content_type = "image/png";
  std::string bytes;
  std::string version;  ///< of the world
};

/// The ground at a point.
struct GroundHeight {
  double alt_ellipsoid_m = 0.0;
  bool imagery = false;  ///< there is imagery
};

/// Thread-safe. Keeps the worlds used last open, and the tiles drawn last. Tiles and heights may be
/// those of files as they were kKnownFor ago.
class MapService {
 public:
  using Cancelled = std::function<bool()>;

  explicit MapService(RunManager& runs) : runs_(runs) {}

  /// The answer of GET worlds (docs/PROTOCOL.md).
  [[nodiscard]] nlohmann::json list();
  /// The world of that name, opened if it is not.
  /// @param progress  called with the share done in [0, 1] while a built-in world is made; without
  /// it, none is made
  /// Errors: kNotFound; kConflict for a built-in world that was not made; as open_scenario_world;
  /// kCancelled.
  [[nodiscard]] Result<std::shared_ptr<const MapWorld>> open(
      const std::string& name,
      const Cancelled& cancelled,
      const std::function<void(double)>& progress = {});
  /// The answer of GET worlds/{name}. Errors: as open.
  [[nodiscard]] Result<nlohmann::json> describe(const std::string& name,
                                                const Cancelled& cancelled,
                                                const std::function<void(double)>& progress = {});
  /// Errors: as open and draw_map_tile; kInvalidArgument for an id that no map has.
  [[nodiscard]] Result<MapTile> tile(const std::string& name,
                                     const MapTileId& id,
                                     const Cancelled& cancelled);
  /// @param points  latitude and longitude [rad], at most kMaxHeightPoints
  /// Errors: as open; kCancelled.
  [[nodiscard]] Result<std::vector<GroundHeight>> heights(const std::string& name,
                                                          const std::vector<Geodetic>& points,
                                                          const Cancelled& cancelled);
  /// A world with an opened scenario's ground, for other uses of this service's worlds.
  [[nodiscard]] Result<std::shared_ptr<const MapWorld>> open(
      const Scenario& scenario,
      const Cancelled& cancelled,
      const std::function<void(double)>& progress = {});

 private:
  static constexpr std::size_t kKeptWorlds = 2;
  /// Finding a world by its name reads all scenarios, which takes longer than drawing a tile.
  static constexpr std::chrono::seconds kKnownFor{2};
  struct Known {
    std::shared_ptr<const MapWorld> world;
    std::chrono::steady_clock::time_point at;
  };
  [[nodiscard]] Result<std::shared_ptr<const MapWorld>> open_again(const std::string& name,
                                                                   const Cancelled& cancelled);
  /// A tile of imagery has some 20 kB.
  static constexpr std::size_t kKeptTiles = 1024;

  RunManager& runs_;
  RecentValues<MapWorld> worlds_{kKeptWorlds};
  RecentValues<Known> names_{kKeptWorlds};
  RecentValues<MapTile> tiles_{kKeptTiles};
};

}  // namespace overfly::server
