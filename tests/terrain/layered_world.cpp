#include "tests/terrain/layered_world.hpp"

#include <ogr_spatialref.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "tests/support/synthetic_world.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using terrain::VerticalDatum;

constexpr int kWidthPx = 620;
constexpr int kHeightPx = 560;
constexpr double kPixelM = 0.5;

struct LonLat {
  double lon_deg = 0.0;
  double lat_deg = 0.0;
};

LonLat lon_lat_of(double x, double y) {
  OGRSpatialReference utm;
  OGRSpatialReference degrees;
  utm.importFromEPSG(32616);
  degrees.importFromEPSG(4326);
  utm.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transform(
      OGRCreateCoordinateTransformation(&utm, &degrees));
  if (!transform || transform->Transform(1, &x, &y) == 0) throw std::runtime_error("no PROJ");
  return {x, y};
}

Image painted(int width, int height, int grey, unsigned seed) {
  if (grey < 0) return textured_image(width, height, 3, seed);
  return {width, height, 3, static_cast<std::uint8_t>(grey)};
}

void write_imagery(const fs::path& folder, const LayerColours& colours) {
  GeoTiff near;
  near.image = painted(kWidthPx, kHeightPx, colours.first, 1);
  near.left = kLayeredLeftM;
  near.top = kLayeredTopM;
  near.pixel = kPixelM;
  near.valid = Image(kWidthPx, kHeightPx, 1, 255);
  for (int y = kHoleFirstPx; y < kHoleLastPx; ++y) {
    for (int x = kHoleFirstPx; x < kHoleLastPx; ++x) near.valid.at(x, y) = 0;
  }
  write_geotiff(folder / "near.tif", near);
  GeoTiff far;
  const LonLat corner = lon_lat_of(kLayeredLeftM - 60.0, kLayeredTopM + 60.0);
  far.image = painted(330, 240, colours.second, 2);
  far.crs = "EPSG:4326";
  far.left = corner.lon_deg;
  far.top = corner.lat_deg;
  far.pixel = 1.5e-5;
  write_geotiff(folder / "far.tif", far);
}

void write_heights(const fs::path& folder) {
  ImageBuffer<float> near(75, 65, 1);
  for (int y = 0; y < near.height_px; ++y) {
    for (int x = 0; x < near.width_px; ++x) {
      const bool hole = x > 30 && x < 45 && y > 25 && y < 40;
      near.at(x, y) = hole ? std::nanf("") : 200.0F + 5.0F * std::sin(0.1F * x) + 0.1F * y;
    }
  }
  write_elevation(folder / "near_heights.tif",
                  near,
                  "EPSG:32616",
                  kLayeredLeftM + 20.0,
                  kLayeredTopM - 20.0,
                  4.0);
  ImageBuffer<float> far(150, 150, 1);
  for (int y = 0; y < far.height_px; ++y) {
    for (int x = 0; x < far.width_px; ++x) far.at(x, y) = 205.0F + 0.02F * x - 0.03F * y;
  }
  const LonLat corner = lon_lat_of(kLayeredLeftM - 400.0, kLayeredTopM + 400.0);
  write_elevation(
      folder / "far_heights.tif", far, "EPSG:4326", corner.lon_deg, corner.lat_deg, 1e-4);
}

}  // namespace

fs::path write_layered_world(const fs::path& folder, const LayerColours& colours) {
  write_imagery(folder, colours);
  write_heights(folder);
  terrain::WorldSpec spec;
  spec.name = "Layers";
  for (const char* file : {"near.tif", "far.tif"}) {
    spec.imagery.emplace_back().file = folder / file;
  }
  for (const char* file : {"near_heights.tif", "far_heights.tif"}) {
    terrain::ElevationLayer& layer = spec.elevation.emplace_back();
    layer.file = folder / file;
    layer.datum = VerticalDatum::kEllipsoid;
  }
  const fs::path manifest = folder / "world.json";
  const Status written = terrain::write_world_manifest(manifest, spec);
  if (!written) throw std::runtime_error(written.error().message);
  return manifest;
}

}  // namespace overfly::testing
