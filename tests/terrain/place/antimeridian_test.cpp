// Worlds across 180 deg: Fiji and Chukotka, in every way in which files count longitudes there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <proj.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include "core/motion/pose.hpp"
#include "terrain/build_world.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::RasterFile;
using testing::TemporaryFolder;

/// A place on the antimeridian, with the UTM zones of its hemisphere.
struct Place {
  const char* name;
  double lat_deg;
  const char* utm_60;
  const char* utm_1;
};
constexpr Place kFiji{"Fiji", -16.8, "EPSG:32760", "EPSG:32701"};
constexpr Place kChukotka{"Chukotka", 67.0, "EPSG:32660", "EPSG:32601"};

/// What the ground is there: a plane in degrees, so that interpolation adds nothing, and waves.
/// @param east_deg  longitude east of the antimeridian
double height_at(const Place& place, double lat_deg, double east_deg) {
  return 300.0 + 2000.0 * east_deg + 900.0 * (lat_deg - place.lat_deg);
}
double grey_at(const Place& place, double lat_deg, double east_deg) {
  return 128.0 + 60.0 * std::sin(50.0 * east_deg) +
         40.0 * std::sin(25.0 * (lat_deg - place.lat_deg));
}

double east_of_antimeridian_deg(double lon_deg) { return std::remainder(lon_deg - 180.0, 360.0); }

/// A reference that uses only PROJ.
class Degrees {
 public:
  explicit Degrees(const std::string& crs) : context_(proj_context_create()) {
    PJ* raw = proj_create_crs_to_crs(context_, crs.c_str(), "EPSG:4326", nullptr);
    transform_ = proj_normalize_for_visualization(context_, raw);
    proj_destroy(raw);
  }
  ~Degrees() {
    proj_destroy(transform_);
    proj_context_destroy(context_);
  }
  Degrees(const Degrees&) = delete;
  Degrees& operator=(const Degrees&) = delete;

  [[nodiscard]] PJ_XY of(double x, double y) const {
    return proj_trans(transform_, PJ_FWD, proj_coord(x, y, 0, 0)).xy;
  }
  [[nodiscard]] PJ_XY from(double lon_deg, double lat_deg) const {
    return proj_trans(transform_, PJ_INV, proj_coord(lon_deg, lat_deg, 0, 0)).xy;
  }

 private:
  PJ_CONTEXT* context_;
  PJ* transform_;
};

enum class Kind { kPicture, kHeights };

/// A raster of the place whose values follow from PROJ's degrees of each pixel's centre.
void write_file(const fs::path& file,
                const Place& place,
                Kind kind,
                const std::string& crs,
                const std::array<double, 6>& transform,
                int width_px,
                int height_px) {
  const auto degrees = std::make_shared<Degrees>(crs);
  RasterFile raster;
  raster.crs = crs;
  raster.transform = transform;
  raster.width_px = width_px;
  raster.height_px = height_px;
  raster.type = kind == Kind::kHeights ? "Float32" : "Byte";
  raster.value = [=](int x, int y, int) {
    const PJ_XY at = degrees->of(transform[0] + (x + 0.5) * transform[1],
                                 transform[3] + (y + 0.5) * transform[5]);
    const double east_deg = east_of_antimeridian_deg(at.x);
    // On the other side of the earth the plane leaves what heights can be.
    if (kind == Kind::kHeights) {
      return std::clamp(height_at(place, at.y, east_deg), -11000.0, 8900.0);
    }
    return std::clamp(std::round(grey_at(place, at.y, east_deg)), 0.0, 255.0);
  };
  testing::write_raster(file, raster);
}

/// Half the side of the square that a file covers [deg of longitude].
double half_deg(Kind kind) { return kind == Kind::kPicture ? 0.02 : 0.04; }

/// Degrees, `west` of the left edge as the file counts it.
void write_degrees(
    const fs::path& file, const Place& place, Kind kind, double west, double width_deg) {
  const double pixel = kind == Kind::kPicture ? 1e-4 : 5e-4;
  const double top = place.lat_deg + half_deg(kind);
  write_file(file,
             place,
             kind,
             "EPSG:4326",
             {west, pixel, 0.0, top, 0.0, -pixel},
             static_cast<int>(std::lround(width_deg / pixel)),
             static_cast<int>(std::lround(2.0 * half_deg(kind) / pixel)));
}

/// Metres, around the place.
void write_metres(const fs::path& file, const Place& place, Kind kind, const std::string& crs) {
  const PJ_XY middle = Degrees(crs).from(180.0, place.lat_deg);
  const double pixel = kind == Kind::kPicture ? 10.0 : 50.0;
  const double half_m = kind == Kind::kPicture ? 1000.0 : 4000.0;
  const int side = static_cast<int>(2.0 * half_m / pixel);
  write_file(file,
             place,
             kind,
             crs,
             {middle.x - half_m, pixel, 0.0, middle.y + half_m, 0.0, -pixel},
             side,
             side);
}

/// Posts around the whole earth, from `west`.
void write_globe(const fs::path& file, const Place& place, double west) {
  constexpr double kPixel = 0.75;
  write_file(file,
             place,
             Kind::kHeights,
             "EPSG:4326",
             {west, kPixel, 0.0, 90.0, 0.0, -kPixel},
             static_cast<int>(360.0 / kPixel),
             static_cast<int>(180.0 / kPixel));
}

/// The ways to cut the earth there; each gives one file or two.
std::vector<fs::path> write_layer(const fs::path& folder,
                                  const Place& place,
                                  Kind kind,
                                  const std::string& how) {
  const std::string name = (kind == Kind::kPicture ? "picture_" : "heights_") + how;
  const fs::path file = folder / (name + ".tif");
  const double half = half_deg(kind);
  if (how == "east_of_180") write_degrees(file, place, kind, 180.0 - half, 2.0 * half);
  if (how == "west_of_-180") write_degrees(file, place, kind, -180.0 - half, 2.0 * half);
  if (how == "utm_60") write_metres(file, place, kind, place.utm_60);
  if (how == "utm_1") write_metres(file, place, kind, place.utm_1);
  if (how == "mercator") {
    // Columns that go on beyond the end of the map's world.
    constexpr double kPixel = 20.0;
    const PJ_XY corner = Degrees("EPSG:3857").from(180.0 - half, place.lat_deg + half);
    const PJ_XY opposite = Degrees("EPSG:3857").from(180.0 - 2.0 * half, place.lat_deg - half);
    write_file(file,
               place,
               kind,
               "EPSG:3857",
               {corner.x, kPixel, 0.0, corner.y, 0.0, -kPixel},
               static_cast<int>(2.0 * (corner.x - opposite.x) / kPixel),
               static_cast<int>((corner.y - opposite.y) / kPixel));
  }
  if (how == "globe_from_-180") write_globe(file, place, -180.0);
  if (how == "globe_from_0") write_globe(file, place, 0.0);
  if (how != "split") return {file};
  const fs::path other = folder / (name + "_2.tif");
  write_degrees(file, place, kind, 180.0 - half, half);
  write_degrees(other, place, kind, -180.0, half);
  return {file, other};
}

WorldSpec spec_of_layers(const std::vector<fs::path>& pictures,
                         const std::vector<fs::path>& heights) {
  WorldSpec spec;
  for (const fs::path& file : pictures) spec.imagery.emplace_back().file = file;
  for (const fs::path& file : heights) {
    spec.elevation.emplace_back().file = file;
    spec.elevation.back().datum = VerticalDatum::kEllipsoid;
  }
  return spec;
}

/// Greys of a world's texels.
class Greys {
 public:
  explicit Greys(const World& world) : tiles_(*world.tiles) {}

  /// Grey of the texel at a place; negative where there is none.
  double at(const Geodetic& place) {
    const TileGrid& grid = tiles_.grid();
    const Eigen::Vector3d p = tiles_.frame().world_from_geodetic(place);
    const Eigen::Vector2d map = tiles_.map_from_world(p.x(), p.y());
    const int i = static_cast<int>(std::floor((map.x() - grid.left_x_m) / grid.texel_m));
    const int j = static_cast<int>(std::floor((grid.top_y_m - map.y()) / grid.texel_m));
    const TileId id{0, i / kTileTexels, j / kTileTexels};
    if (!(read_ && id == read_->first)) {
      auto tile = tiles_.tile(id);
      if (!tile) return -1.0;
      read_.emplace(id, std::move(*tile));
    }
    const Tile& tile = read_->second;
    const int u = i % kTileTexels + kTileBorder;
    const int v = j % kTileTexels + kTileBorder;
    return tile.valid.at(u, v) == 0 ? -1.0 : tile.rgb.at(u, v, 0);
  }

 private:
  const TileSource& tiles_;
  std::optional<std::pair<TileId, Tile>> read_;  ///< the last one
};

/// Heights and colours on both sides of the antimeridian are those of the files' places.
/// @param tolerance_m  of heights
void expect_right_places(const World& world, const Place& place, double tolerance_m = 0.02) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Greys greys(world);
  for (int i = 0; i < 60; ++i) {
    // Within 700 m of the place: all files have it.
    const double lat_deg = place.lat_deg + 0.006 * unit(random);
    const double east_deg = 0.006 * unit(random);
    const Geodetic at = geodetic_from_deg(lat_deg, 180.0 + east_deg, 300.0);
    const Eigen::Vector3d p = world.tiles->frame().world_from_geodetic(at);
    const double up_m = world.tiles->ground_up_m(p.x(), p.y());
    const Geodetic ground = world.tiles->frame().geodetic_from_world({p.x(), p.y(), up_m});
    ASSERT_NEAR(ground.alt_ellipsoid_m,
                height_at(place,
                          deg_from_rad(ground.lat_rad),
                          east_of_antimeridian_deg(deg_from_rad(ground.lon_rad))),
                tolerance_m)
        << lat_deg << " " << east_deg;
    // A texel, up to 20 m, is 0.6 grey levels wide.
    ASSERT_NEAR(greys.at(at), grey_at(place, lat_deg, east_deg), 2.0) << lat_deg << " " << east_deg;
  }
}

constexpr const char* kWays[] = {
    "east_of_180", "west_of_-180", "split", "utm_60", "utm_1", "mercator"};

class AcrossTheAntimeridian : public ::testing::TestWithParam<Place> {
 protected:
  [[nodiscard]] std::vector<fs::path> layer(Kind kind, const std::string& way) const {
    return write_layer(folder_.path(), GetParam(), kind, way);
  }
  TemporaryFolder folder_;
};

TEST_P(AcrossTheAntimeridian, PicturesLieAtTheirPlaceHoweverTheyCount) {
  const auto heights = layer(Kind::kHeights, "east_of_180");
  for (const char* way : kWays) {
    SCOPED_TRACE(way);
    const auto world = open_world(spec_of_layers(layer(Kind::kPicture, way), heights));
    ASSERT_TRUE(world) << world.error().message;
    EXPECT_THAT(world->warnings, IsEmpty());
    expect_right_places(*world, GetParam());
  }
}

TEST_P(AcrossTheAntimeridian, HeightsLieAtTheirPlaceHoweverTheyCount) {
  for (const char* of_picture : {"east_of_180", "utm_60"}) {
    const auto picture = layer(Kind::kPicture, of_picture);
    for (const char* way :
         {"west_of_-180", "utm_60", "utm_1", "mercator", "globe_from_-180", "globe_from_0"}) {
      SCOPED_TRACE(std::string(way) + " under " + of_picture);
      const auto world = open_world(spec_of_layers(picture, layer(Kind::kHeights, way)));
      ASSERT_TRUE(world) << world.error().message;
      EXPECT_THAT(world->warnings, IsEmpty());
      expect_right_places(*world, GetParam());
    }
    // Two files are laid onto one grid, whose corners no file has; from the last post of one to the
    // first of the other each goes on with its edge's height: half a post of slope.
    const auto world = open_world(spec_of_layers(picture, layer(Kind::kHeights, "split")));
    ASSERT_TRUE(world) << world.error().message;
    EXPECT_THAT(world->warnings, IsEmpty());
    expect_right_places(*world, GetParam(), 0.5 * 5e-4 * 2000.0 + 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Places,
                         AcrossTheAntimeridian,
                         ::testing::Values(kFiji, kChukotka),
                         [](const auto& place) { return std::string(place.param.name); });

/// The western edge has the greater longitude, as in GeoJSON.
TEST(Antimeridian, BoundsGoFromWestToEastAcrossIt) {
  const TemporaryFolder folder;
  const auto heights = write_layer(folder.path(), kFiji, Kind::kHeights, "utm_60");
  for (const char* way : {"east_of_180", "west_of_-180", "split"}) {
    const auto pictures = write_layer(folder.path(), kFiji, Kind::kPicture, way);
    const auto world = open_world(spec_of_layers(pictures, heights));
    ASSERT_TRUE(world) << world.error().message;
    const std::string text = describe(*world);
    const std::size_t at = text.find("bounds: ");
    double south = 0.0;
    double north = 0.0;
    double west = 0.0;
    double east = 0.0;
    ASSERT_EQ(std::sscanf(text.c_str() + at,
                          "bounds: %lf to %lf deg N, %lf to %lf deg E",
                          &south,
                          &north,
                          &west,
                          &east),
              4)
        << text;
    EXPECT_NEAR(south, kFiji.lat_deg - 0.02, 1e-4);
    EXPECT_NEAR(north, kFiji.lat_deg + 0.02, 1e-4);
    EXPECT_NEAR(west, 180.0 - 0.02, 1e-4) << way;
    EXPECT_NEAR(east, -180.0 + 0.02, 1e-4) << way;
  }
}

/// Files that end before the antimeridian, with ground that reaches beyond it.
TEST(Antimeridian, AWorldBesideItOpens) {
  const TemporaryFolder folder;
  for (const double lon_deg : {179.8, -179.8}) {
    const fs::path picture = folder.path() / "picture.tif";
    write_degrees(picture, kFiji, Kind::kPicture, lon_deg - 0.01, 0.02);
    const fs::path heights = folder.path() / "heights.tif";
    write_degrees(heights, kFiji, Kind::kHeights, lon_deg - 0.04, 0.08);
    const auto world = open_world(spec_of_layers({picture}, {heights}));
    ASSERT_TRUE(world) << world.error().message;
    EXPECT_THAT(world->warnings, IsEmpty());
    EXPECT_NEAR(world->spec.origin->alt_ellipsoid_m,
                height_at(kFiji, kFiji.lat_deg, east_of_antimeridian_deg(lon_deg)),
                0.1);
    EXPECT_NEAR(
        std::remainder(deg_from_rad(world->spec.origin->lon_rad) - lon_deg, 360.0), 0.0, 1e-4);
  }
}

/// A zone's own area ends at 180 deg; a file a little beyond is not far outside of it.
TEST(Antimeridian, AFileBeyondItsZoneIsNotFarOutside) {
  const TemporaryFolder folder;
  for (const char* way : {"utm_60", "utm_1"}) {
    const auto pictures = write_layer(folder.path(), kChukotka, Kind::kPicture, way);
    WorldSpec spec = spec_of_layers(pictures, {});
    spec.ground_height_m = 10.0;
    const auto world = open_world(spec);
    ASSERT_TRUE(world) << world.error().message;
    EXPECT_THAT(world->warnings, IsEmpty());
  }
}

TEST(Antimeridian, AWorldAcrossItIsBuiltAndFlownFromItsCache) {
  const TemporaryFolder folder;
  WorldSpec spec =
      spec_of_layers(write_layer(folder.path(), kFiji, Kind::kPicture, "split"),
                     write_layer(folder.path(), kFiji, Kind::kHeights, "globe_from_-180"));
  spec.cache_folder = folder.path() / "world.cache";
  const auto built = build_world(spec);
  ASSERT_TRUE(built) << built.error().message;
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_THAT(world->cache, HasSubstr("in use"));
  expect_right_places(*world, kFiji);
}

}  // namespace
}  // namespace overfly::terrain
