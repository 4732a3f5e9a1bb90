#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/motion/pose.hpp"
#include "terrain/cache/world_disk_cache.hpp"
#include "terrain/cancelled.hpp"
#include "terrain/files/file_digest.hpp"
#include "terrain/files/side_cars.hpp"
#include "terrain/place/raster_turns.hpp"
#include "terrain/world.hpp"
#include "terrain/world/raster_world.hpp"
#include "terrain/world/world_layout.hpp"

namespace overfly::terrain {
namespace {

using Rasters = std::vector<std::shared_ptr<const ImageryRaster>>;

/// Files of one sample type get one range of values, so that a mosaic has no steps at its seams.
void share_ranges(const std::vector<ImageryLayer>& layers,
                  const std::vector<std::shared_ptr<ImageryRaster>>& rasters,
                  std::vector<std::string>& warnings) {
  const auto chosen = [&](std::size_t i) {
    return rasters[i]->bands().rescaled && !layers[i].range;
  };
  std::map<GDALDataType, std::pair<double, double>> ranges;
  for (std::size_t i = 0; i < rasters.size(); ++i) {
    if (!chosen(i)) continue;
    const RasterBands& bands = rasters[i]->bands();
    const auto [range, added] = ranges.try_emplace(bands.type, bands.low, bands.high);
    range->second.first = std::min(range->second.first, bands.low);
    range->second.second = std::max(range->second.second, bands.high);
  }
  for (std::size_t i = 0; i < rasters.size(); ++i) {
    if (!chosen(i)) continue;
    auto [low, high] = ranges.at(rasters[i]->bands().type);
    if (low > high) low = high = 0.0;  // every file is void
    if (low == high) high = low + 1.0;
    rasters[i]->set_range(low, high);
    warnings.push_back(rasters[i]->file().string() + ": samples are " +
                       GDALGetDataTypeName(rasters[i]->bands().type) + "; values " +
                       std::to_string(low) + " to " + std::to_string(high) +
                       " are shown as 0 to 255; set \"range\" in the manifest to choose others");
  }
}

Result<Rasters> open_imagery(const WorldSpec& spec,
                             const Cancelled& cancelled,
                             std::vector<std::string>& warnings) {
  if (spec.imagery.empty()) {
    return Error{ErrorCode::kInvalidArgument, "imagery: is empty; a world needs at least one file"};
  }
  std::vector<std::shared_ptr<ImageryRaster>> rasters;
  for (const ImageryLayer& layer : spec.imagery) {
    if (Status status = go_on(cancelled, layer.file); !status) return status.error();
    auto raster = ImageryRaster::open(layer, cancelled, warnings);
    if (!raster) return raster.error();
    rasters.push_back(std::move(*raster));
  }
  share_ranges(spec.imagery, rasters, warnings);
  return Rasters(rasters.begin(), rasters.end());
}

/// Warns of files next to those of the layers that are ignored.
void add_side_car_doubts(const WorldSpec& spec, std::vector<std::string>& warnings) {
  SideCars side_cars;
  const auto add = [&](const std::filesystem::path& file) {
    const std::vector<std::string> doubts = side_cars.doubts(file);
    warnings.insert(warnings.end(), doubts.begin(), doubts.end());
  };
  for (const ImageryLayer& layer : spec.imagery) add(layer.file);
  for (const ElevationLayer& layer : spec.elevation) add(layer.file);
}

/// Preparation needed only for reading the files themselves.
Status prepare(const Rasters& rasters,
               const Cancelled& cancelled,
               std::vector<std::string>& warnings) {
  for (const auto& raster : rasters) {
    if (Status status = go_on(cancelled, raster->file()); !status) return status;
    Status prepared = raster->prepare(cancelled);
    if (!prepared) return prepared;
    const std::vector<std::string> doubts = raster->doubts();
    warnings.insert(warnings.end(), doubts.begin(), doubts.end());
  }
  return {};
}

/// The layers, without the knowledge of where they have texels.
Result<std::vector<MappedImagery>> map_imagery(const Rasters& rasters,
                                               const WorldLayout& layout,
                                               const Cancelled& cancelled) {
  std::vector<MappedImagery> layers;
  for (std::size_t i = 0; i < rasters.size(); ++i) {
    if (Status status = go_on(cancelled, rasters[i]->file()); !status) return status.error();
    if (i == 0 && layout.first_aligned) {
      layers.push_back(MappedImagery::aligned(rasters[i], layout.grid, layout.pad_x, layout.pad_y));
      continue;
    }
    const auto turns = MappedImagery::turns_over_grid(*rasters[i], layout.plane, layout.grid);
    if (!turns) return turns.error();
    for (const std::optional<Turn>& turn : *turns) {
      auto layer = MappedImagery::warped(rasters[i], layout.plane, layout.grid, turn);
      if (!layer) return layer.error();
      layers.push_back(std::move(*layer));
    }
  }
  return layers;
}

Status find_validity(std::vector<MappedImagery>& layers,
                     const Cancelled& cancelled,
                     const WorldDiskCache* cache) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const ImageryRaster& raster = layers[i].raster();
    if (Status status = go_on(cancelled, raster.file()); !status) return status;
    std::optional<ValidityGrid> known;
    if (cache != nullptr) {
      auto kept = cache->validity(static_cast<int>(i), raster.width_px(), raster.height_px());
      if (!kept) return kept.error();
      known = std::move(*kept);
    }
    Status found = layers[i].find_validity(std::move(known), cancelled);
    if (!found) return found;
  }
  return {};
}

/// A layer without valid texels is a warning, a world without any is an error.
Status check_picture(const std::vector<MappedImagery>& layers, std::vector<std::string>& warnings) {
  std::size_t empty = 0;
  for (const MappedImagery& layer : layers) {
    if (layer.validity() == nullptr || layer.validity()->any()) continue;
    ++empty;
    warnings.push_back(layer.raster().file().string() +
                       ": every texel is void by its mask or nodata value; the file is not used");
  }
  if (empty < layers.size()) return {};
  return Error{ErrorCode::kInvalidArgument,
               layers.front().raster().file().string() +
                   ": every texel is void by its mask or nodata value: there is no picture to fly "
                   "over"};
}

/// Opens elevation to about the horizon of a low flight; with all posts only as far around the
/// imagery as can be read fast.
Result<ElevationModel> open_elevation(const WorldSpec& spec,
                                      const WorldLayout& layout,
                                      std::vector<std::string>& warnings) {
  if (spec.elevation.empty()) {
    if (!spec.ground_height_m) {
      warnings.emplace_back(
          "neither elevation nor a ground height is given: the ground is the ellipsoid (height 0). "
          "Positions on the map are correct, heights above the ellipsoid are not");
    }
    return ElevationModel::flat(spec.ground_height_m.value_or(0.0));
  }
  constexpr double kReachesM[] = {30e3, 10e3, 3e3, 300.0};
  constexpr double kMaxPosts = 40e6;
  constexpr double kMaxFarPosts = 10e6;
  Error last;
  for (const double reach_m : kReachesM) {
    std::vector<std::string> doubts;
    const bool least = reach_m == kReachesM[3];
    auto model = ElevationModel::open(spec.elevation,
                                      layout.plane,
                                      layout.extent,
                                      layout.extent.grown(reach_m),
                                      least ? std::numeric_limits<double>::max() : kMaxPosts,
                                      doubts);
    if (model) {
      if (reach_m < kReachesM[0]) {
        const Status extended = model->extend(spec.elevation,
                                              layout.plane,
                                              layout.extent,
                                              layout.extent.grown(kReachesM[0]),
                                              kMaxFarPosts);
        if (!extended) return extended.error();
      }
      warnings.insert(warnings.end(), doubts.begin(), doubts.end());
      return model;
    }
    last = model.error();
    if (last.code != ErrorCode::kUnsupported) break;
  }
  return last;
}

std::string credit_line(const WorldSpec& spec) {
  std::string line;
  std::set<std::string> named;
  const auto add = [&](const std::string& credit) {
    if (credit.empty() || !named.insert(credit).second) return;
    line += (line.empty() ? "" : "; ") + credit;
  };
  for (const ImageryLayer& layer : spec.imagery) add(layer.attribution);
  for (const ElevationLayer& layer : spec.elevation) add(layer.attribution);
  return line;
}

Status check_spec(const WorldSpec& spec, const WorldLayout& layout) {
  if (spec.ground_height_m && !(std::abs(*spec.ground_height_m) <= 12000.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 "ground_height_m = " + std::to_string(*spec.ground_height_m) +
                     ": must be in [-12000, 12000]"};
  }
  if (!spec.origin) return {};
  const Geodetic middle{layout.center_lat_rad, layout.center_lon_rad, 0.0};
  const Geodetic origin{spec.origin->lat_rad, spec.origin->lon_rad, 0.0};
  const double away_m = (ecef_from_geodetic(middle) - ecef_from_geodetic(origin)).norm();
  constexpr double kFarthestM = 500e3;
  if (!(away_m <= kFarthestM)) {
    return Error{ErrorCode::kInvalidArgument,
                 "origin: lies " + std::to_string(static_cast<long>(away_m / 1000.0)) +
                     " km from the imagery, limit 500 km"};
  }
  return {};
}

Status add_digests(World& world, const Cancelled& cancelled, const WorldDiskCache* cache) {
  const auto add = [&](const std::filesystem::path& file) -> Status {
    if (Status status = go_on(cancelled, file); !status) return status;
    if (cache != nullptr) {
      for (const CacheSource& source : cache->header().sources) {
        if (source_path(world.spec, source) != std::filesystem::absolute(file).lexically_normal()) {
          continue;
        }
        world.data_hashes.emplace_back(file.string(), source.digest);
        return {};
      }
    }
    auto digest = file_digest(file);
    if (!digest) return digest.error();
    world.data_hashes.emplace_back(file.string(), *digest);
    return {};
  };
  for (const ImageryLayer& layer : world.spec.imagery) {
    Status added = add(layer.file);
    if (!added) return added;
  }
  for (const ElevationLayer& layer : world.spec.elevation) {
    Status added = add(layer.file);
    if (!added) return added;
  }
  return {};
}

/// Looks for a matching cache and records the result in the world.
std::shared_ptr<const WorldDiskCache> find_cache(const WorldSpec& spec,
                                                 const std::string& fingerprint,
                                                 World& world) {
  WorldDiskCache::Found found = WorldDiskCache::find(spec);
  if (found.cache && found.cache->header().layout != fingerprint) {
    found.cache = nullptr;
    found.stale = "PROJ or its grids now georeference these files differently";
  }
  world.cache = "none";
  if (found.cache) {
    constexpr double kMega = 1e-6;
    world.cache = "in use: " + found.cache->folder().string() + ", " +
                  std::to_string(
                      static_cast<long>(kMega * static_cast<double>(found.cache->header().bytes))) +
                  " MB";
  } else if (!found.stale.empty()) {
    world.cache = "stale: " + found.stale;
    world.warnings.push_back(spec.cache_folder.string() + ": is not used: " + found.stale +
                             "; the files are read directly. Run `overfly world build`");
  }
  return found.cache;
}

}  // namespace

Result<World> open_world(const WorldSpec& spec, const Cancelled& cancelled) {
  if (spec.sources.confined()) {
    if (Status status = check_world_sources(spec, ""); !status) return status.error();
  }
  World world;
  world.spec = spec;
  add_side_car_doubts(spec, world.warnings);
  auto rasters = open_imagery(spec, cancelled, world.warnings);
  if (!rasters) return rasters.error();
  auto layout = lay_out_world(*rasters, spec.origin);
  if (!layout) return layout.error();
  const Status sane = check_spec(spec, *layout);
  if (!sane) return sane.error();
  auto elevation = open_elevation(spec, *layout, world.warnings);
  if (!elevation) return elevation.error();
  auto imagery = map_imagery(*rasters, *layout, cancelled);
  if (!imagery) return imagery.error();
  const auto cache = find_cache(spec, world_fingerprint(layout->grid, *imagery, *elevation), world);
  if (!cache) {
    const Status prepared = prepare(*rasters, cancelled, world.warnings);
    if (!prepared) return prepared.error();
  }
  const Status valid = find_validity(*imagery, cancelled, cache.get());
  if (!valid) return valid.error();
  const Status picture = check_picture(*imagery, world.warnings);
  if (!picture) return picture.error();
  if (elevation->heights() != nullptr) {
    const Status ready = cache ? elevation->use(cache, world.warnings)
                               : elevation->survey(cancelled, world.warnings);
    if (!ready) return ready.error();
  }

  if (!world.spec.origin) {
    const MapRect& all = layout->extent;
    const double height_m =
        elevation->height_m(0.5 * (all.x_min + all.x_max), 0.5 * (all.y_min + all.y_max));
    world.spec.origin = Geodetic{layout->center_lat_rad, layout->center_lon_rad, height_m};
  }
  const LocalFrame frame(*world.spec.origin);
  // As far as the polynomial is valid: to the horizon if the projection allows.
  Result<MapGeodesy> geodesy = Error{};
  for (const double reach_m : {50e3, 10e3, 1e3}) {
    geodesy = MapGeodesy::create(layout->plane, frame, layout->extent.grown(reach_m));
    if (geodesy) break;
  }
  if (!geodesy) return geodesy.error().in(rasters->front()->file().string());
  world.tiles = std::make_shared<RasterWorld>(layout->grid,
                                              std::move(*imagery),
                                              std::move(*elevation),
                                              std::move(*geodesy),
                                              frame,
                                              credit_line(spec),
                                              cache);
  const Status hashed = add_digests(world, cancelled, cache.get());
  if (!hashed) return hashed.error();
  return world;
}

}  // namespace overfly::terrain
