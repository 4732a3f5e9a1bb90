#include <cmath>
#include <cstdio>

#include "core/pose.hpp"
#include "terrain/geoid.hpp"
#include "terrain/raster_world.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {
namespace {

template <typename... Values>
std::string line(const char* format, Values... values) {
  char text[1024];
  std::snprintf(text, sizeof(text), format, values...);
  return std::string(text) + "\n";
}

std::string crs_name(const OGRSpatialReference& crs) {
  const char* name = crs.GetName();
  const char* authority = crs.GetAuthorityName(nullptr);
  const char* code = crs.GetAuthorityCode(nullptr);
  std::string text = name != nullptr ? name : "unnamed";
  if (authority != nullptr && code != nullptr) {
    text += std::string(" (") + authority + ":" + code + ")";
  }
  return text;
}

/// Share of the grid's area without imagery, from a lattice of look-ups.
double gap_share(const TileSource& tiles) {
  const TileGrid& grid = tiles.grid();
  constexpr int kSteps = 200;
  int gaps = 0;
  for (int j = 0; j < kSteps; ++j) {
    for (int i = 0; i < kSteps; ++i) {
      const double x = grid.left_x_m + (i + 0.5) / kSteps * grid.width_m;
      const double y = grid.top_y_m - (j + 0.5) / kSteps * grid.height_m;
      gaps += !tiles.has_imagery(x, y);
    }
  }
  return static_cast<double>(gaps) / (kSteps * kSteps);
}

std::string layers(const World& world) {
  std::string text;
  const auto* source = dynamic_cast<const RasterWorld*>(world.tiles.get());
  if (source == nullptr) return text;
  for (const MappedImagery& layer : source->imagery()) {
    const ImageryRaster& raster = layer.raster();
    text += line("imagery: %s, %s, %d x %d px, %s, %s%s",
                 raster.file().string().c_str(),
                 raster.format().c_str(),
                 raster.width_px(),
                 raster.height_px(),
                 crs_name(raster.georeference().crs).c_str(),
                 layer.resampled() ? "resampled onto the map" : "used texel for texel",
                 raster.has_mask() ? ", masked" : "");
  }
  for (const ElevationLayer& layer : world.spec.elevation) {
    text += line(
        "elevation: %s, vertical datum %s", layer.file.string().c_str(), to_string(layer.datum));
  }
  if (world.spec.elevation.empty()) {
    text += line("elevation: none, flat ground at %.2f m above the ellipsoid",
                 world.tiles->height_range_m().x());
  } else {
    text += line("elevation posts: every %.2f m", source->elevation().spacing_m());
  }
  return text;
}

}  // namespace

std::string describe(const World& world) {
  const TileSource& tiles = *world.tiles;
  const TileGrid& grid = tiles.grid();
  const Geodetic& origin = tiles.frame().origin();
  std::string text;
  if (!world.spec.name.empty()) text += line("name: %s", world.spec.name.c_str());
  text += line("origin: %.7f deg N, %.7f deg E, %.2f m above the ellipsoid",
               deg_from_rad(origin.lat_rad),
               deg_from_rad(origin.lon_rad),
               origin.alt_ellipsoid_m);
  text += line("extent: %.0f x %.0f m", grid.width_m, grid.height_m);
  text += line("resolution: %.4g m per texel, %d levels", grid.texel_m, grid.levels);
  text += line("imagery gaps: %.2f %% of the extent", 100.0 * gap_share(tiles));
  text += line("ground: %.1f to %.1f m above the ellipsoid",
               tiles.height_range_m().x(),
               tiles.height_range_m().y());
  text += layers(world);
  if (world.spec.runway) {
    text += line("runway: north threshold %.7f deg N, %.7f deg E, take-off heading %.1f deg",
                 deg_from_rad(world.spec.runway->lat_rad),
                 deg_from_rad(world.spec.runway->lon_rad),
                 deg_from_rad(world.spec.runway->heading_rad));
  }
  for (const std::string& warning : world.warnings) text += "warning: " + warning + "\n";
  const std::string credit = tiles.attribution();
  text += "attribution: " + (credit.empty() ? "none given" : credit) + "\n";
  return text;
}

}  // namespace overfly::terrain
