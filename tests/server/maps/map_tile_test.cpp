// Tiles of maps against PROJ, which places single points, and against GDAL's warper.
#include "server/maps/map_tile.hpp"

#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "core/motion/pose.hpp"
#include "server/maps/ground_place.hpp"
#include "tests/server/support/server_fixture.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server {
namespace {

using overfly::testing::GeoTiff;
using overfly::testing::TemporaryFolder;

/// A world of imagery in a CRS, with hills of 80 m where the CRS is that of the hills.
class MapFixture {
 public:
  MapFixture(const GeoTiff& tiff, const ImageBuffer<float>* heights) {
    const auto imagery = folder_.path() / "imagery.tif";
    overfly::testing::write_geotiff(imagery, tiff);
    terrain::WorldSpec spec;
    spec.name = "map";
    spec.imagery.push_back({imagery, "made for the test"});
    if (heights != nullptr) {
      const auto elevation = folder_.path() / "elevation.tif";
      const double span = tiff.pixel * tiff.image.width_px;
      overfly::testing::write_elevation(
          elevation, *heights, tiff.crs, tiff.left, tiff.top, span / heights->width_px);
      terrain::ElevationLayer layer;
      layer.file = elevation;
      layer.datum = terrain::VerticalDatum::kEllipsoid;
      spec.elevation.push_back(layer);
    } else {
      spec.ground_height_m = 250.0;
    }
    auto opened = std::make_shared<OpenedWorld>();
    opened->world = terrain::open_world(spec).value();
    world_ = std::make_unique<MapWorld>(opened, "test");
  }
  [[nodiscard]] const MapWorld& world() const { return *world_; }
  [[nodiscard]] std::filesystem::path imagery() const { return folder_.path() / "imagery.tif"; }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<MapWorld> world_;
};

/// EPSG:3857 [m] of a point by PROJ.
Eigen::Vector2d proj_mercator(const std::string& crs, double x, double y) {
  OGRSpatialReference from;
  OGRSpatialReference to;
  from.SetFromUserInput(crs.c_str());
  to.importFromEPSG(3857);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transformation(
      OGRCreateCoordinateTransformation(&from, &to));
  EXPECT_TRUE(transformation->Transform(1, &x, &y));
  return {x, y};
}

constexpr double kHalfM = 20037508.342789244;

/// In pixels of the map at a zoom level, from the north-west corner of the world.
Eigen::Vector2d map_pixel(const Eigen::Vector2d& mercator_m, int zoom) {
  const double scale = kMapTilePx * std::ldexp(1.0, zoom) / (2.0 * kHalfM);
  return {(mercator_m.x() + kHalfM) * scale, (kHalfM - mercator_m.y()) * scale};
}

MapTileId tile_around(const Eigen::Vector2d& pixel, int zoom) {
  return {zoom,
          static_cast<int>(std::floor(pixel.x() / kMapTilePx)),
          static_cast<int>(std::floor(pixel.y() / kMapTilePx))};
}

/// Black with white squares.
GeoTiff squares(const std::string& crs,
                double left,
                double top,
                double pixel,
                const std::vector<Eigen::Vector2i>& centres,
                int half) {
  GeoTiff tiff;
  tiff.crs = crs;
  tiff.left = left;
  tiff.top = top;
  tiff.pixel = pixel;
  tiff.image = Image(1200, 1200, 3);
  for (const Eigen::Vector2i& at : centres) {
    for (int y = at.y() - half; y < at.y() + half; ++y) {
      for (int x = at.x() - half; x < at.x() + half; ++x) {
        for (int c = 0; c < 3; ++c) tiff.image.at(x, y, c) = 255;
      }
    }
  }
  return tiff;
}

ImageBuffer<float> hills() {
  ImageBuffer<float> heights(60, 60, 1);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) {
      heights.at(x, y) = static_cast<float>(200.0 + 80.0 * std::sin(0.3 * x) * std::cos(0.2 * y));
    }
  }
  return heights;
}

/// Centre of what is bright within a window around a pixel of the map.
Eigen::Vector2d bright_centre(const MapWorld& world,
                              const Eigen::Vector2d& around,
                              int zoom,
                              int window) {
  Eigen::Vector2d sum(0.0, 0.0);
  double weight = 0.0;
  std::map<std::pair<int, int>, Image> tiles;
  for (int dy = -window; dy <= window; ++dy) {
    for (int dx = -window; dx <= window; ++dx) {
      const Eigen::Vector2d at(std::floor(around.x()) + dx, std::floor(around.y()) + dy);
      const MapTileId id = tile_around(at, zoom);
      const auto [known, is_new] = tiles.try_emplace({id.x, id.y});
      if (is_new) known->second = draw_map_tile(world, id).value();
      const Image& image = known->second;
      if (image.empty()) continue;
      const double value = image.at(static_cast<int>(at.x()) - id.x * kMapTilePx,
                                    static_cast<int>(at.y()) - id.y * kMapTilePx);
      sum += value * (at + Eigen::Vector2d(0.5, 0.5));
      weight += value;
    }
  }
  EXPECT_GT(weight, 255.0);
  return sum / weight;
}

struct Case {
  const char* crs;
  double left;
  double top;
  double pixel;
  bool hilly;
};

TEST(MapTile, PutsPointsWhereProjPutsThem) {
  const std::vector<Eigen::Vector2i> centres = {{90, 90}, {600, 600}, {1110, 80}, {100, 1090}};
  double farthest = 0.0;
  for (const Case& each : {Case{"EPSG:32616", 583000.0, 4357000.0, 0.5, true},
                           Case{"EPSG:2994", 830000.0, 870000.0, 2.0, false},
                           Case{"EPSG:4326", -86.04, 39.36, 5e-6, false},
                           Case{"EPSG:32633", 300000.0, 7700000.0, 1.0, true}}) {
    SCOPED_TRACE(each.crs);
    const ImageBuffer<float> heights = hills();
    const MapFixture map(squares(each.crs, each.left, each.top, each.pixel, centres, 12),
                         each.hilly ? &heights : nullptr);
    const int finest = map.world().finest_zoom();
    for (const int zoom : {finest - 2, finest - 1, finest, finest + 1}) {
      for (const Eigen::Vector2i& centre : centres) {
        const Eigen::Vector2d expected = map_pixel(
            proj_mercator(
                each.crs, each.left + centre.x() * each.pixel, each.top - centre.y() * each.pixel),
            zoom);
        // A square of 24 texels has at most 48 pixels at the finest level.
        const int window = zoom > finest ? 64 : 36;
        const double off = (bright_centre(map.world(), expected, zoom, window) - expected).norm();
        farthest = std::max(farthest, off);
        EXPECT_LT(off, 0.5) << "zoom " << zoom;
      }
    }
  }
  std::printf("map tiles: farthest of a point from PROJ's place [px]: %.3f\n", farthest);
}

struct DatasetCloser {
  void operator()(GDALDatasetH dataset) const { GDALClose(dataset); }
};

/// The tile by GDAL: RGB, averaged or interpolated.
Image warped(const std::filesystem::path& file, const MapTileId& id) {
  const double side = 2.0 * kHalfM / std::ldexp(1.0, id.zoom);
  const auto text = [](double value) {
    char buffer[64];
    std::snprintf(buffer, sizeof(buffer), "%.9f", value);
    return std::string(buffer);
  };
  std::vector<std::string> words = {"-of",
                                    "MEM",
                                    "-t_srs",
                                    "EPSG:3857",
                                    "-r",
                                    "average",
                                    "-et",
                                    "0",
                                    "-ts",
                                    "256",
                                    "256",
                                    "-te",
                                    text(-kHalfM + id.x * side),
                                    text(kHalfM - (id.y + 1) * side),
                                    text(-kHalfM + (id.x + 1) * side),
                                    text(kHalfM - id.y * side)};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(arguments.data(), nullptr);
  const std::unique_ptr<void, DatasetCloser> source(GDALOpen(file.c_str(), GA_ReadOnly));
  GDALDatasetH sources[] = {source.get()};
  const std::unique_ptr<void, DatasetCloser> made(
      GDALWarp("", nullptr, 1, sources, options, nullptr));
  GDALWarpAppOptionsFree(options);
  Image image(kMapTilePx, kMapTilePx, 3);
  int bands[] = {1, 2, 3};
  EXPECT_EQ(GDALDataset::FromHandle(made.get())
                ->RasterIO(GF_Read,
                           0,
                           0,
                           256,
                           256,
                           image.data.data(),
                           256,
                           256,
                           GDT_Byte,
                           3,
                           bands,
                           3,
                           static_cast<GSpacing>(3) * 256,
                           1,
                           nullptr),
            CE_None);
  return image;
}

/// RMS difference of the green channel where the tile is shifted by pixels.
double difference(const Image& tile, const Image& other, int dx, int dy) {
  double sum = 0.0;
  int count = 0;
  for (int y = 4; y < 252; ++y) {
    for (int x = 4; x < 252; ++x) {
      if (tile.at(x, y, 3) < 255) continue;
      const double off = tile.at(x, y, 1) - other.at(x + dx, y + dy, 1);
      sum += off * off;
      ++count;
    }
  }
  return std::sqrt(sum / std::max(count, 1));
}

TEST(MapTile, AgreesWithTheWarperOfGdal) {
  GeoTiff tiff;
  tiff.image = overfly::testing::textured_image(1600, 1600, 3);
  tiff.left = 583000.0;
  tiff.top = 4357000.0;
  tiff.pixel = 0.5;
  const MapFixture map(tiff, nullptr);
  const Eigen::Vector2d middle = proj_mercator(tiff.crs, tiff.left + 400.0, tiff.top - 400.0);
  for (const int zoom : {15, 16, 17, 18}) {
    const MapTileId id = tile_around(map_pixel(middle, zoom), zoom);
    const Image tile = draw_map_tile(map.world(), id).value();
    ASSERT_FALSE(tile.empty());
    const Image other = warped(map.imagery(), id);
    const double here = difference(tile, other, 0, 0);
    std::printf("map tile at zoom %d: RMS difference to GDAL's warper: %.2f\n", zoom, here);
    EXPECT_LT(here, 6.0);
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      EXPECT_LT(here, 0.7 * difference(tile, other, dx, dy)) << zoom << ": " << dx << ", " << dy;
    }
  }
}

TEST(MapTile, IsTransparentWhereThereIsNoImagery) {
  const ImageBuffer<float> heights = hills();
  const MapFixture map(squares("EPSG:32616", 583000.0, 4357000.0, 0.5, {}, 1), &heights);
  const int zoom = 16;
  const Eigen::Vector2d corner = map_pixel(proj_mercator("EPSG:32616", 583000.0, 4357000.0), zoom);
  const MapTileId id = tile_around(corner, zoom);
  const Image tile = draw_map_tile(map.world(), id).value();
  ASSERT_EQ(tile.channels, 4);
  const int x = static_cast<int>(corner.x()) - id.x * kMapTilePx;
  const int y = static_cast<int>(corner.y()) - id.y * kMapTilePx;
  EXPECT_EQ(tile.at(std::min(x + 4, 255), std::min(y + 4, 255), 3), 255);
  EXPECT_EQ(tile.at(std::max(x - 4, 0), std::max(y - 4, 0), 3), 0);
  EXPECT_TRUE(draw_map_tile(map.world(), {zoom, id.x + 40, id.y})->empty());
  EXPECT_TRUE(draw_map_tile(map.world(), {zoom, 0, 0})->empty());
  // The whole world on one tile: a few pixels at most.
  EXPECT_TRUE(draw_map_tile(map.world(), {0, 0, 0}).ok());
  EXPECT_FALSE(draw_map_tile(map.world(), {12, id.x / 16, id.y / 16})->empty());
}

TEST(MapTile, CrossesTheAntimeridian) {
  // UTM zone 60 around 180 deg.
  GeoTiff tiff = squares("EPSG:32660", 709000.0, -0.0 + 5000600.0, 1.0, {{600, 600}}, 200);
  const double edge = 180.0;
  OGRSpatialReference utm;
  OGRSpatialReference wgs84;
  utm.importFromEPSG(32660);
  wgs84.importFromEPSG(4326);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to_utm(
      OGRCreateCoordinateTransformation(&wgs84, &utm));
  double x = edge;
  double y = 45.15;
  ASSERT_TRUE(to_utm->Transform(1, &x, &y));
  tiff.left = x - 600.0;
  tiff.top = y + 600.0;
  const MapFixture map(tiff, nullptr);
  const int zoom = 14;
  const int last = (1 << zoom) - 1;
  const Eigen::Vector2d middle = map_pixel(proj_mercator("EPSG:4326", 179.9999, 45.15), zoom);
  const int row = static_cast<int>(middle.y() / kMapTilePx);
  const Image west = draw_map_tile(map.world(), {zoom, last, row}).value();
  const Image east = draw_map_tile(map.world(), {zoom, 0, row}).value();
  ASSERT_FALSE(west.empty());
  ASSERT_FALSE(east.empty());
  const int y_px = static_cast<int>(middle.y()) - row * kMapTilePx;
  EXPECT_GT(west.at(254, y_px), 200);
  EXPECT_GT(east.at(1, y_px), 200);
}

TEST(MapTile, EndsWhenItIsCancelled) {
  const MapFixture map(squares("EPSG:32616", 583000.0, 4357000.0, 0.5, {}, 1), nullptr);
  const Eigen::Vector2d middle = map_pixel(proj_mercator("EPSG:32616", 583300.0, 4356700.0), 17);
  const auto drawn = draw_map_tile(map.world(), tile_around(middle, 17), [] { return true; });
  ASSERT_FALSE(drawn.ok());
  EXPECT_EQ(drawn.error().code, ErrorCode::kCancelled);
}

TEST(GroundPlace, IsOnTheNormalOfItsPlace) {
  const ImageBuffer<float> heights = hills();
  const MapFixture map(squares("EPSG:32616", 583000.0, 4357000.0, 0.5, {}, 1), &heights);
  const terrain::TileSource& tiles = map.world().tiles();
  for (const double east : {583050.0, 583300.0, 583550.0}) {
    const Eigen::Vector2d mercator = proj_mercator("EPSG:32616", east, 4356700.0);
    const Geodetic place = geodetic_from_mercator(
        {0.5 + mercator.x() / (2.0 * kHalfM), 0.5 - mercator.y() / (2.0 * kHalfM)});
    const GroundPlace ground = ground_at(tiles, place);
    EXPECT_NEAR(ground.map_m.x(), east, 1e-3);
    EXPECT_NEAR(ground.map_m.y(), 4356700.0, 1e-3);
    const Geodetic found = tiles.frame().geodetic_from_world(ground.world_m);
    EXPECT_NEAR(found.lat_rad, place.lat_rad, 1e-10);
    EXPECT_NEAR(found.alt_ellipsoid_m, ground.alt_ellipsoid_m, 1e-6);
  }
}

}  // namespace
}  // namespace overfly::server
