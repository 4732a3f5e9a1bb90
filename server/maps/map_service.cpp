#include "server/maps/map_service.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/motion/pose.hpp"
#include "server/files/jpeg.hpp"
#include "server/files/png_file.hpp"
#include "server/maps/ground_place.hpp"
#include "server/maps/map_tile.hpp"
#include "server/maps/world_list.hpp"
#include "server/worlds/world_extent.hpp"
#include "terrain/height_errors.hpp"
#include "terrain/sea_level.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

constexpr int kQuality = 85;
/// The extent in pixels below which a map of the world is useless.
constexpr double kLeastMapPx = 64.0;

/// @param step  a part of 1
double rounded_to(double value, double step) {
  const double parts = std::round(1.0 / step);
  return std::round(value * parts) / parts;
}

/// 1e-9 deg is 0.1 mm.
Json degrees(double angle_rad) { return rounded_to(deg_from_rad(angle_rad), 1e-9); }

Json place_json(const Geodetic& place) {
  return {{"lat_deg", degrees(place.lat_rad)},
          {"lon_deg", degrees(place.lon_rad)},
          {"alt_ellipsoid_m", rounded_to(place.alt_ellipsoid_m, 1e-3)}};
}

Json runway_json(const MapWorld& world) {
  const auto& runway = world.world().spec.runway;
  if (!runway) return nullptr;
  const double guess_m = world.tiles().frame().origin().alt_ellipsoid_m;
  const GroundPlace ground = ground_at(world.tiles(), {runway->lat_rad, runway->lon_rad, guess_m});
  Json json = place_json({runway->lat_rad, runway->lon_rad, ground.alt_ellipsoid_m});
  json["heading_deg"] = degrees(runway->heading_rad);
  return json;
}

Json description(const std::string& name, const Json& world_value, const MapWorld& world) {
  const WorldExtent extent = extent_of(world.world());
  Json outline = Json::array();
  for (const Geodetic& place : extent.outline) outline.push_back(place_json(place));
  const Geodetic low = geodetic_from_mercator(world.box().low);
  const Geodetic high = geodetic_from_mercator(world.box().high);
  const double span = (world.box().high - world.box().low).minCoeff();
  const int least =
      std::clamp(static_cast<int>(std::ceil(std::log2(kLeastMapPx / (kMapTilePx * span)))),
                 0,
                 world.finest_zoom());
  return {{"name", name},
          {"title", extent.name},
          {"attribution", extent.attribution},
          {"world", world_value},
          {"version", world.version()},
          {"centre", place_json(extent.centre)},
          {"outline", std::move(outline)},
          {"bounds",
           {{"west_deg", degrees(low.lon_rad)},
            {"north_deg", degrees(low.lat_rad)},
            {"east_deg", degrees(high.lon_rad)},
            {"south_deg", degrees(high.lat_rad)}}},
          {"origin", place_json(world.tiles().frame().origin())},
          {"runway", runway_json(world)},
          {"sea_level_ellipsoid_m", rounded_to(terrain::sea_level_m(extent.centre), 1e-2)},
          {"texel_m", world.tiles().real_texel_m()},
          {"tile_px", kMapTilePx},
          {"min_zoom", least},
          {"max_zoom", world.finest_zoom()}};
}

/// What clients are told in place of a world's imagery where there is none.
const MapTile& empty_tile() {
  static const MapTile tile = [] {
    const auto png = encode_png(Image(kMapTilePx, kMapTilePx, 4));
    return MapTile{"image/png", std::string(png.begin(), png.end()), {}};
  }();
  return tile;
}

Result<MapTile> encoded_tile(const Image& image) {
  if (image.empty()) return empty_tile();
  bool opaque = true;
  Image rgb(image.width_px, image.height_px, 3);
  for (std::size_t i = 0; i < rgb.data.size() / 3; ++i) {
    std::copy_n(&image.data[4 * i], 3, &rgb.data[3 * i]);
    opaque = opaque && image.data[4 * i + 3] == 255;
  }
  if (!opaque) {
    const auto png = encode_png(image);
    return MapTile{"image/png", std::string(png.begin(), png.end()), {}};
  }
  const auto jpeg = encode_jpeg(rgb, kQuality);
  if (!jpeg) return jpeg.error();
  return MapTile{"image/jpeg", std::string(jpeg->begin(), jpeg->end()), {}};
}

}  // namespace

Json MapService::list() {
  const WorldList list = list_worlds(runs_);
  Json worlds = Json::array();
  for (const WorldEntry& entry : list.worlds) {
    worlds.push_back({{"name", entry.name},
                      {"title", entry.title},
                      {"world", entry.world},
                      {"made", entry.made},
                      {"scenarios", entry.scenarios}});
  }
  return {{"worlds", std::move(worlds)}, {"complete", list.complete}};
}

Result<std::shared_ptr<const MapWorld>> MapService::open(
    const Scenario& scenario,
    const Cancelled& cancelled,
    const std::function<void(double)>& progress) {
  if (!progress && world_must_be_made(scenario)) {
    return Error{ErrorCode::kConflict, "the built-in world was not made yet"};
  }
  const auto go_on = [&](double share) {
    if (progress) progress(share);
    return !cancelled || !cancelled();
  };
  // Looks whether the files have changed, and opens the world only if it has to.
  const auto opened = runs_.open_world(scenario, go_on);
  if (!opened) return opened.error();
  const std::string key = world_key(scenario);
  if (auto known = worlds_.find(key); known && known->opened() == *opened) return known;
  auto world = std::make_shared<const MapWorld>(*opened, key);
  worlds_.keep(key, world);
  return world;
}

Result<std::shared_ptr<const MapWorld>> MapService::open(
    const std::string& name,
    const Cancelled& cancelled,
    const std::function<void(double)>& progress) {
  const Result<Scenario> scenario = scenario_over(runs_, name);
  if (!scenario) return scenario.error();
  return open(*scenario, cancelled, progress);
}

Result<std::shared_ptr<const MapWorld>> MapService::open_again(const std::string& name,
                                                               const Cancelled& cancelled) {
  const auto now = std::chrono::steady_clock::now();
  if (const auto known = names_.find(name); known && now - known->at < kKnownFor) {
    return known->world;
  }
  auto world = open(name, cancelled);
  if (world) names_.keep(name, std::make_shared<const Known>(Known{*world, now}));
  return world;
}

Result<Json> MapService::describe(const std::string& name,
                                  const Cancelled& cancelled,
                                  const std::function<void(double)>& progress) {
  const Result<Scenario> scenario = scenario_over(runs_, name);
  if (!scenario) return scenario.error();
  const auto world = open(*scenario, cancelled, progress);
  if (!world) return world.error();
  return description(name, scenario->resolved.at("world"), **world);
}

Result<MapTile> MapService::tile(const std::string& name,
                                 const MapTileId& id,
                                 const Cancelled& cancelled) {
  const int side = id.zoom >= 0 && id.zoom <= kMaxMapZoom ? 1 << id.zoom : 0;
  if (id.x < 0 || id.x >= side || id.y < 0 || id.y >= side) {
    return Error{ErrorCode::kInvalidArgument,
                 "tile " + std::to_string(id.zoom) + "/" + std::to_string(id.x) + "/" +
                     std::to_string(id.y) + ": the zoom must be in [0, " +
                     std::to_string(kMaxMapZoom) + "], x and y in [0, 2^zoom)"};
  }
  const auto world = open_again(name, cancelled);
  if (!world) return world.error();
  const std::string key = (*world)->version() + " " + name + " " + std::to_string(id.zoom) + "/" +
                          std::to_string(id.x) + "/" + std::to_string(id.y);
  if (const auto known = tiles_.find(key)) return *known;
  const Result<Image> image = draw_map_tile(**world, id, cancelled);
  if (!image) return image.error();
  Result<MapTile> made = encoded_tile(*image);
  if (!made) return made;
  made->version = (*world)->version();
  tiles_.keep(key, std::make_shared<const MapTile>(*made));
  return made;
}

Result<std::vector<GroundHeight>> MapService::heights(const std::string& name,
                                                      const std::vector<Geodetic>& points,
                                                      const Cancelled& cancelled) {
  const auto world = open_again(name, cancelled);
  if (!world) return world.error();
  const terrain::TileSource& tiles = (*world)->tiles();
  const terrain::HeightErrors errors;
  std::vector<GroundHeight> heights;
  heights.reserve(points.size());
  double guess_m = tiles.frame().origin().alt_ellipsoid_m;
  for (const Geodetic& point : points) {
    if (cancelled && cancelled()) return Error{ErrorCode::kCancelled, "heights were cancelled"};
    const GroundPlace ground = ground_at(tiles, {point.lat_rad, point.lon_rad, guess_m});
    guess_m = ground.alt_ellipsoid_m;
    heights.push_back({guess_m, tiles.has_imagery(ground.map_m.x(), ground.map_m.y())});
  }
  if (Status read = errors.status(); !read) return read.error();
  return heights;
}

}  // namespace overfly::server
