#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/motion/pose.hpp"
#include "core/text/percent.hpp"
#include "terrain/place/geoid.hpp"
#include "terrain/world.hpp"
#include "terrain/world/drape.hpp"
#include "terrain/world/raster_world.hpp"

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

/// Fraction of the grid's area without imagery, sampled on a lattice.
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

std::string imagery_lines(const RasterWorld& source) {
  std::string text;
  const ImageryRaster* before = nullptr;
  for (const MappedImagery& layer : source.imagery()) {
    const ImageryRaster& raster = layer.raster();
    if (&raster == before) continue;  // the same file on another turn of the earth
    before = &raster;
    const ValidityGrid* validity = layer.validity();
    text += line("imagery: %s, %s, %d x %d px of %.4g m, %s, %s",
                 raster.file().string().c_str(),
                 raster.format().c_str(),
                 raster.width_px(),
                 raster.height_px(),
                 layer.file_texel_m(),
                 crs_name(raster.georeference().crs).c_str(),
                 layer.resampled() ? "resampled onto the map" : "used texel for texel");
    if (validity != nullptr) {
      text += line("  masked: %s of it is void", percent_text(validity->void_share()).c_str());
    }
  }
  return text;
}

std::string elevation_lines(const World& world, const RasterWorld& source) {
  std::string text;
  if (world.spec.elevation.empty()) {
    return line("elevation: none, flat ground at %.2f m above the ellipsoid",
                world.tiles->height_range_m().x());
  }
  const std::vector<std::string> relations = source.elevation().relations();
  const std::vector<HeightDatum> datums = source.elevation().datums();
  for (std::size_t i = 0; i < world.spec.elevation.size(); ++i) {
    const ElevationLayer& layer = world.spec.elevation[i];
    const bool of_file = layer.datum == VerticalDatum::kUnknown && !datums[i].named.empty();
    text += line("elevation: %s, vertical datum %s%s, to the ellipsoid by %s",
                 layer.file.string().c_str(),
                 to_string(datums[i].datum),
                 of_file ? (" (the file's: " + datums[i].named + ")").c_str() : "",
                 relations[i].c_str());
  }
  const ElevationModel& model = source.elevation();
  if (model.far() == nullptr) {
    return text + line("elevation posts: every %.2f m", model.spacing_m());
  }
  return text +
         line("elevation posts: every %.2f m to %.0f m around the imagery, every %.2f m beyond",
              model.spacing_m(),
              model.near_reach_m(),
              model.far()->spacing_m());
}

/// The range of latitude and longitude of the imagery; across the antimeridian the western
/// longitude is the greater number, as in GeoJSON (RFC 7946, sec. 5.2).
std::string bounds_line(const TileSource& tiles) {
  const TileGrid& grid = tiles.grid();
  double low_lat = 90.0;
  double high_lat = -90.0;
  const double origin_lon = deg_from_rad(tiles.frame().origin().lon_rad);
  double low_lon = origin_lon + 360.0;
  double high_lon = origin_lon - 360.0;
  constexpr int kSteps = 8;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const Geodetic at = tiles.frame().geodetic_from_world(tiles.world_from_map(
          grid.left_x_m + grid.width_m * i / kSteps, grid.top_y_m - grid.height_m * j / kSteps));
      low_lat = std::min(low_lat, deg_from_rad(at.lat_rad));
      high_lat = std::max(high_lat, deg_from_rad(at.lat_rad));
      const double lon = unwrapped(deg_from_rad(at.lon_rad), origin_lon, 360.0);
      low_lon = std::min(low_lon, lon);
      high_lon = std::max(high_lon, lon);
    }
  }
  return line("bounds: %.6f to %.6f deg N, %.6f to %.6f deg E",
              low_lat,
              high_lat,
              unwrapped(low_lon, 0.0, 360.0),
              unwrapped(high_lon, 0.0, 360.0));
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
  text += bounds_line(tiles);
  text += line("resolution: %.4g m per texel, %d levels", grid.texel_m, grid.levels);
  text += line("imagery gaps: %s of the extent", percent_text(gap_share(tiles)).c_str());
  text += line("smeared: %s of the imagery lies on slopes above 60 deg",
               percent_text(stretched_share(tiles)).c_str());
  text += line("ground: %.1f to %.1f m above the ellipsoid",
               tiles.height_range_m().x(),
               tiles.height_range_m().y());
  if (const auto* source = dynamic_cast<const RasterWorld*>(world.tiles.get())) {
    text += imagery_lines(*source) + elevation_lines(world, *source);
  }
  if (world.spec.runway) {
    text += line("runway: north threshold %.7f deg N, %.7f deg E, take-off heading %.1f deg",
                 deg_from_rad(world.spec.runway->lat_rad),
                 deg_from_rad(world.spec.runway->lon_rad),
                 deg_from_rad(world.spec.runway->heading_rad));
  }
  text += "cache: " + world.cache + "\n";
  for (const std::string& warning : world.warnings) text += "warning: " + warning + "\n";
  const std::string credit = tiles.attribution();
  text += "attribution: " + (credit.empty() ? "none given" : credit) + "\n";
  return text;
}

}  // namespace overfly::terrain
