// Inside terrain only: the tile source over imagery and elevation files.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "terrain/cache/world_disk_cache.hpp"
#include "terrain/elevation/elevation_model.hpp"
#include "terrain/imagery/mapped_imagery.hpp"
#include "terrain/place/map_plane.hpp"

namespace overfly::terrain {

/// World coordinates of the ground as functions of the map: p = foot + height * up. Uses a
/// polynomial within its error bound inside its domain, and PROJ outside.
class MapGeodesy {
 public:
  /// Errors: kInvalidArgument if the plane cannot be transformed around the domain.
  static Result<MapGeodesy> create(const MapPlane& plane,
                                   const LocalFrame& frame,
                                   const MapRect& domain);

  [[nodiscard]] Eigen::Vector3d world(double x_map_m, double y_map_m, double height_m) const;
  /// The same at several places. PROJ is called once for all outside of the domain.
  /// @param heights_m  one per place
  [[nodiscard]] std::vector<Eigen::Vector3d> world(std::span<const Eigen::Vector2d> places_map_m,
                                                   std::span<const double> heights_m) const;
  /// Map point whose world point at this height has these east and north, to first order: a start
  /// value for an iteration.
  [[nodiscard]] Eigen::Vector2d map_near(double east_m, double north_m) const;
  /// d(map) / d(east, north) at the centre of the domain.
  [[nodiscard]] const Eigen::Matrix2d& map_per_world() const { return map_per_world_; }

 private:
  /// World coordinates of the point on the ellipsoid and of its upward normal.
  using Ground = SmoothMap<6>;
  [[nodiscard]] Ground::Value ground(double x_map_m, double y_map_m) const;
  [[nodiscard]] Ground::Value ground_from_geodetic(double lat_rad, double lon_rad) const;

  MapPlane plane_;
  std::optional<LocalFrame> frame_;
  std::optional<Ground> ground_;
  Eigen::Vector2d middle_map_m_{0.0, 0.0};
  Eigen::Vector2d middle_world_m_{0.0, 0.0};
  Eigen::Matrix2d map_per_world_ = Eigen::Matrix2d::Identity();
};

class RasterWorld final : public TileSource {
 public:
  RasterWorld(TileGrid grid,
              std::vector<MappedImagery> imagery,
              ElevationModel elevation,
              MapGeodesy geodesy,
              const LocalFrame& frame,
              std::string attribution,
              std::shared_ptr<const WorldDiskCache> cache)
      : grid_(grid),
        imagery_(std::move(imagery)),
        elevation_(std::move(elevation)),
        geodesy_(std::move(geodesy)),
        frame_(frame),
        attribution_(std::move(attribution)),
        cache_(std::move(cache)) {}

  [[nodiscard]] const TileGrid& grid() const override { return grid_; }
  [[nodiscard]] TileCoverage coverage(const TileId& id) const override;
  [[nodiscard]] Eigen::Vector3d world_from_map(double x_map_m, double y_map_m) const override;
  [[nodiscard]] Eigen::Vector3d coarse_world_from_map(double x_map_m,
                                                      double y_map_m,
                                                      double spacing_m) const override;
  [[nodiscard]] std::vector<Eigen::Vector3d> coarse_world_at(
      std::span<const Eigen::Vector2d> places_map_m, double spacing_m) const override;
  [[nodiscard]] Eigen::Vector2d map_from_world(double east_m, double north_m) const override;
  [[nodiscard]] double ground_up_m(double east_m, double north_m) const override;
  [[nodiscard]] bool has_imagery(double x_map_m, double y_map_m) const override;
  [[nodiscard]] const LocalFrame& frame() const override { return frame_; }
  [[nodiscard]] Eigen::Vector2d height_range_m() const override { return elevation_.range_m(); }
  [[nodiscard]] std::string attribution() const override { return attribution_; }
  [[nodiscard]] Status status() const override { return elevation_.status(); }

  [[nodiscard]] const std::vector<MappedImagery>& imagery() const { return imagery_; }
  [[nodiscard]] const ElevationModel& elevation() const { return elevation_; }

 private:
  [[nodiscard]] Result<Tile> read_tile(const TileId& id, const Cancelled& cancelled) const override;
  TileGrid grid_;
  std::vector<MappedImagery> imagery_;
  ElevationModel elevation_;
  MapGeodesy geodesy_;
  LocalFrame frame_;
  std::string attribution_;
  std::shared_ptr<const WorldDiskCache> cache_;  ///< null if tiles are read from the files
};

/// Grid, imagery and heights as text: equal for equal places of tiles, texels and posts.
[[nodiscard]] std::string world_fingerprint(const TileGrid& grid,
                                            const std::vector<MappedImagery>& imagery,
                                            const ElevationModel& elevation);

}  // namespace overfly::terrain
