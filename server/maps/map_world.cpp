#include "server/maps/map_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "core/measure/sha256.hpp"
#include "core/motion/pose.hpp"
#include "server/maps/mercator.hpp"
#include "server/worlds/world_extent.hpp"

namespace overfly::server {
namespace {

/// Of the box, around the outline's points: a side of the imagery bends between them.
constexpr double kMargin = 0.02;

MercatorBox box_of(const WorldExtent& extent) {
  const Eigen::Vector2d centre =
      mercator_from_geodetic(extent.centre.lat_rad, extent.centre.lon_rad);
  MercatorBox box{centre, centre};
  for (const Geodetic& corner : extent.outline) {
    Eigen::Vector2d place = mercator_from_geodetic(corner.lat_rad, corner.lon_rad);
    place.x() -= std::round(place.x() - centre.x());
    box.low = box.low.cwiseMin(place);
    box.high = box.high.cwiseMax(place);
  }
  const Eigen::Vector2d margin = kMargin * (box.high - box.low);
  return {box.low - margin, box.high + margin};
}

std::string version_of(const OpenedWorld& opened, const std::string& key) {
  std::string text;
  const auto add = [&text](const std::string& part) { (text += part) += '\0'; };
  add(key);
  add(opened.manifest ? opened.manifest->digest : std::string());
  for (const auto& [file, digest] : opened.world.data_hashes) {
    add(file);
    add(digest);
  }
  // Side-cars and the sources of virtual rasters have no digest; those of large files are samples.
  for (const terrain::WorldFile& file : opened.files) {
    add(file.file.string());
    if (!file.identity) continue;
    add(std::to_string(file.identity->size_bytes) + " " +
        std::to_string(file.identity->modified_ns) + " " +
        std::to_string(file.identity->changed_ns));
  }
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()),
                                            text.size());
  constexpr std::size_t kDigits = 16;
  return sha256_hex(bytes).substr(0, kDigits);
}

}  // namespace

MapWorld::MapWorld(std::shared_ptr<const OpenedWorld> opened, const std::string& key)
    : opened_(std::move(opened)), version_(version_of(*opened_, key)) {
  const WorldExtent extent = extent_of(opened_->world);
  box_ = box_of(extent);
  const double coarse_m = map_pixel_m(extent.centre.lat_rad, 0);
  finest_zoom_ = std::clamp(
      static_cast<int>(std::ceil(std::log2(coarse_m / tiles().grid().texel_m))), 0, kMaxMapZoom);
}

Result<std::shared_ptr<const terrain::Tile>> MapWorld::tile(
    const terrain::TileId& id, const terrain::Cancelled& cancelled) const {
  const std::string key =
      std::to_string(id.level) + "/" + std::to_string(id.col) + "/" + std::to_string(id.row);
  if (std::shared_ptr<const terrain::Tile> known = kept_.find(key)) return known;
  Result<terrain::Tile> read = tiles().tile(id, cancelled);
  if (!read) return read.error();
  auto tile = std::make_shared<const terrain::Tile>(std::move(*read));
  kept_.keep(key, tile);
  return tile;
}

}  // namespace overfly::server
