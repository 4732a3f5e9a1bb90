// The same ground in different coordinate systems is the same picture at the same place.
#include <gtest/gtest.h>
#include <proj.h>

#include <cmath>
#include <random>

#include "core/motion/pose.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::terrain {
namespace {

using testing::TemporaryFolder;

Result<World> open_file(const std::filesystem::path& file) {
  WorldSpec spec;
  spec.imagery.push_back({file, "", {}});
  spec.ground_height_m = 100.0;
  return open_world(spec);
}

/// Grey level of level 0 at a map place, bilinear between texel centres; NaN where void.
class Sampler {
 public:
  explicit Sampler(const World& world) : tiles_(*world.tiles) {}
  double at(const Eigen::Vector2d& map) {
    const TileGrid& grid = tiles_.grid();
    const double u = (map.x() - grid.left_x_m) / grid.texel_m - 0.5;
    const double v = (grid.top_y_m - map.y()) / grid.texel_m - 0.5;
    const int i = static_cast<int>(std::floor(u));
    const int j = static_cast<int>(std::floor(v));
    const double s = u - i;
    const double t = v - j;
    return (1 - t) * ((1 - s) * texel(i, j) + s * texel(i + 1, j)) +
           t * ((1 - s) * texel(i, j + 1) + s * texel(i + 1, j + 1));
  }

 private:
  double texel(int i, int j) {
    const auto floor_div = [](int a) {
      return a >= 0 ? a / kTileTexels : -((-a + kTileTexels - 1) / kTileTexels);
    };
    const TileId id{0, floor_div(i), floor_div(j)};
    if (!loaded_ || *loaded_ != id) {
      auto tile = tiles_.tile(id);
      if (!tile) return std::nan("");
      tile_ = std::move(*tile);
      loaded_ = id;
    }
    const int x = i - id.col * kTileTexels + kTileBorder;
    const int y = j - id.row * kTileTexels + kTileBorder;
    return tile_.valid.at(x, y) == 0 ? std::nan("") : tile_.rgb.at(x, y, 1);
  }
  const TileSource& tiles_;
  std::optional<TileId> loaded_;
  Tile tile_;
};

/// Displacement of b against a in metres (east, north), by least squares on the grey levels of a
/// patch around the world's origin of a.
Eigen::Vector2d displacement_m(const World& a, const World& b, double half_m, double step_m) {
  Sampler in_a(a);
  Sampler in_b(b);
  const auto place = [&](const World& world, const Geodetic& at) {
    const Eigen::Vector3d p = world.tiles->frame().world_from_geodetic(at);
    return world.tiles->map_from_world(p.x(), p.y());
  };
  const auto grey = [&](Sampler& sampler, const World& world, double east, double north) {
    const Geodetic at =
        a.tiles->frame().geodetic_from_world({east, north, a.tiles->ground_up_m(east, north)});
    return sampler.at(place(world, at));
  };
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (double north = -half_m; north <= half_m; north += step_m) {
    for (double east = -half_m; east <= half_m; east += step_m) {
      const double h = 0.5 * step_m;
      const double gx = (grey(in_a, a, east + h, north) - grey(in_a, a, east - h, north)) / step_m;
      const double gy = (grey(in_a, a, east, north + h) - grey(in_a, a, east, north - h)) / step_m;
      const double error = grey(in_b, b, east, north) - grey(in_a, a, east, north);
      if (std::isnan(gx + gy + error)) continue;
      const Eigen::Vector3d row(-gx, -gy, 1.0);
      normal += row * row.transpose();
      right += row * error;
    }
  }
  return normal.ldlt().solve(right).head<2>();
}

TEST(SamePlace, AutzenInMetresAndInFeet) {
  OVERFLY_DATA_OR_SKIP(metres, "terrain/autzen/ortho_0.3m_utm10.tif");
  OVERFLY_DATA_OR_SKIP(feet, "terrain/autzen/ortho_epsg2994_ft.tif");
  const auto a = open_file(metres);
  const auto b = open_file(feet);
  ASSERT_TRUE(a && b);
  const Eigen::Vector2d shift_m = displacement_m(*a, *b, 60.0, 0.6);
  // A quarter of a texel: the metric file was itself resampled from the other.
  EXPECT_LT(shift_m.norm(), 0.08) << shift_m.transpose();
}

TEST(SamePlace, DegreesAgainstProjOnItsOwn) {
  OVERFLY_DATA_OR_SKIP(file, "terrain/goleta/ortho_epsg4326.tif");
  const auto world = open_file(file);
  ASSERT_TRUE(world) << world.error().message;
  // The file's own georeference: pixel corners every 3.0273437500e-05 deg from
  // (-119.8337, 34.4448).
  constexpr double kPixelDeg = 3.0273437500e-05;
  PJ_CONTEXT* context = proj_context_create();
  PJ* to_ecef = proj_create(context, "+proj=cart +ellps=WGS84");
  std::mt19937 random(1);
  std::uniform_int_distribution<int> pixel(5, 506);
  for (int i = 0; i < 200; ++i) {
    const double lon_deg = -119.8337 + pixel(random) * kPixelDeg;
    const double lat_deg = 34.4448 - pixel(random) * kPixelDeg;
    const PJ_COORD ecef = proj_trans(
        to_ecef, PJ_FWD, proj_coord(rad_from_deg(lon_deg), rad_from_deg(lat_deg), 100.0, 0.0));
    const Eigen::Vector3d p =
        world->tiles->frame().world_from_ecef(Eigen::Vector3d(ecef.xyz.x, ecef.xyz.y, ecef.xyz.z));
    const Eigen::Vector2d map = world->tiles->map_from_world(p.x(), p.y());
    const Eigen::Vector3d back = world->tiles->world_from_map(map.x(), map.y());
    EXPECT_LT((back - p).norm(), 1e-3);
  }
  proj_destroy(to_ecef);
  proj_context_destroy(context);
}

/// One checkerboard corner's place is known: its texels must be there in every CRS.
TEST(SamePlace, ACornerOfACheckerboardInEveryKindOfCrs) {
  struct Case {
    const char* crs;
    double left;
    double top;
    double pixel;
  };
  const Case cases[] = {{"EPSG:32616", 583000.0, 4357000.0, 1.0},   // UTM, metres
                        {"EPSG:2994", 637000.0, 852000.0, 3.0},     // Lambert, feet
                        {"EPSG:3857", -9577000.0, 4774000.0, 1.3},  // Web Mercator
                        {"EPSG:4326", -86.03, 39.35, 1e-5},         // degrees
                        {"EPSG:32756", 334000.0, 6250000.0, 1.0}};  // southern UTM
  TemporaryFolder folder;
  for (const Case& c : cases) {
    testing::GeoTiff tiff;
    constexpr int kSquare = 40;
    tiff.image = testing::checkerboard_image(400, 400, kSquare);
    tiff.crs = c.crs;
    tiff.left = c.left;
    tiff.top = c.top;
    tiff.pixel = c.pixel;
    const auto file = folder.path() / "board.tif";
    testing::write_geotiff(file, tiff);
    const auto world = open_file(file);
    ASSERT_TRUE(world) << c.crs << ": " << world.error().message;

    PJ_CONTEXT* context = proj_context_create();
    PJ* raw = proj_create_crs_to_crs(context, c.crs, "EPSG:4326", nullptr);
    PJ* to_wgs84 = proj_normalize_for_visualization(context, raw);
    Sampler sampler(*world);
    for (const int corner : {2, 5, 8}) {
      // Half a square from the corner in each direction lie the middles of its four squares.
      for (int quadrant = 0; quadrant < 4; ++quadrant) {
        for (const double reach : {0.5 * kSquare, 2.5}) {
          const double px = corner * kSquare + (quadrant % 2 == 0 ? -reach : reach);
          const double py = corner * kSquare + (quadrant / 2 == 0 ? -reach : reach);
          const PJ_COORD lon_lat = proj_trans(
              to_wgs84, PJ_FWD, proj_coord(c.left + px * c.pixel, c.top - py * c.pixel, 0.0, 0.0));
          const Eigen::Vector3d p = world->tiles->frame().world_from_geodetic(
              geodetic_from_deg(lon_lat.xy.y, lon_lat.xy.x, 100.0));
          const bool light = (quadrant == 1 || quadrant == 2);
          EXPECT_NEAR(sampler.at(world->tiles->map_from_world(p.x(), p.y())), light ? 220 : 35, 16)
              << c.crs << " corner " << corner << " quadrant " << quadrant << " reach " << reach;
        }
      }
    }
    proj_destroy(to_wgs84);
    proj_destroy(raw);
    proj_context_destroy(context);
  }
}

}  // namespace
}  // namespace overfly::terrain
