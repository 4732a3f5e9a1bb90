// Pictures of real files, each pixel compared with the file itself as GDAL and PROJ know it.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/renderer.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"
#include "tests/terrain/elevation/independent_elevation.hpp"

namespace overfly::renderer {
namespace {

namespace fs = std::filesystem;
using testing::IndependentElevation;
using testing::TemporaryFolder;

constexpr double kFocalPx = 350.0;

CameraModel small_camera() {
  PinholeCamera camera;
  camera.width_px = 480;
  camera.height_px = 360;
  camera.fx_px = camera.fy_px = kFocalPx;
  camera.cx_px = 239.5;
  camera.cy_px = 179.5;
  return camera;
}

/// Looks straight down, image top to the north.
Pose above(const terrain::World& world, double height_m) {
  Pose pose;
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0;
  pose.rotation = Eigen::Quaterniond(R_world_camera);
  pose.translation = {0.0, 0.0, world.tiles->ground_up_m(0.0, 0.0) + height_m};
  return pose;
}

struct Picture {
  Image rgb;
  DepthImage depth_m;
  Pose T_world_camera;
};

Picture draw(const terrain::World& world, const Pose& T_world_camera) {
  const auto renderer = create_raycast_renderer(world.tiles);
  auto frame = renderer->render_camera(small_camera(), T_world_camera, 0, PixelFormat::kRgb8);
  auto depth = renderer->render_depth(small_camera(), T_world_camera);
  if (!frame || !depth) throw std::runtime_error("not drawn");
  return {std::move(frame->image), std::move(*depth), T_world_camera};
}

/// The place on earth that a pixel shows.
Geodetic place_of(const terrain::World& world, const Picture& picture, int x, int y) {
  const Eigen::Vector3d ray = *small_camera().ray({x, y});
  return world.tiles->frame().geodetic_from_world(picture.T_world_camera *
                                                  (ray * picture.depth_m.at(x, y)));
}

double decibel(double square_sum, int count) {
  return 10.0 * std::log10(255.0 * 255.0 / (square_sum / count));
}

/// Red of the picture against the file's at the same place, bilinear.
/// @param north_px  how far from the place the file is read, in pixels of the picture
double psnr_with_file_db(const terrain::World& world,
                         const Picture& picture,
                         const IndependentElevation& file,
                         double north_px) {
  double sum = 0.0;
  int count = 0;
  constexpr double kEarthRadiusM = 6371e3;
  for (int y = 2; y < picture.rgb.height_px; y += 5) {
    for (int x = 2; x < picture.rgb.width_px; x += 5) {
      const Geodetic place = place_of(world, picture, x, y);
      const double north_m = north_px * picture.depth_m.at(x, y) / kFocalPx;
      const double value = file.value_at(place.lat_rad + north_m / kEarthRadiusM, place.lon_rad);
      if (std::isnan(value)) continue;
      const double error = picture.rgb.at(x, y, 0) - value;
      sum += error * error;
      ++count;
    }
  }
  EXPECT_GT(count, 5000);
  return decibel(sum, count);
}

double psnr_db(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    const double error = a.data[i] - b.data[i];
    sum += error * error;
  }
  return decibel(sum, static_cast<int>(a.data.size()));
}

terrain::World opened(const fs::path& imagery,
                      const fs::path& elevation,
                      const std::optional<Geodetic>& origin = {},
                      const std::optional<std::string>& crs = {}) {
  terrain::WorldSpec spec;
  spec.imagery.emplace_back().file = imagery;
  spec.imagery.back().crs = crs;
  spec.origin = origin;
  spec.ground_height_m = 100.0;
  if (!elevation.empty()) {
    spec.elevation.emplace_back().file = elevation;
    spec.elevation.back().datum = terrain::VerticalDatum::kEllipsoid;
  }
  auto world = terrain::open_world(spec);
  if (!world) throw std::runtime_error(world.error().message);
  return std::move(*world);
}

/// The picture is the file's at its place, and at no other.
void expect_file_in_its_place(const terrain::World& world,
                              const fs::path& file,
                              const std::string& crs,
                              double texel_m,
                              double least_db) {
  // Half a texel to a pixel: the picture is the imagery magnified, as bilinear sampling gives it.
  const Picture picture = draw(world, above(world, 0.5 * texel_m * kFocalPx));
  const IndependentElevation direct(file, crs);
  const double here_db = psnr_with_file_db(world, picture, direct, 0.0);
  EXPECT_GT(here_db, least_db) << file;
  for (const double north_px : {-1.0, 1.0}) {
    EXPECT_LT(psnr_with_file_db(world, picture, direct, north_px), here_db - 3.0) << file;
  }
}

TEST(RealWorld, AutzenLooksTheSameInMetresAndInFeet) {
  OVERFLY_DATA_OR_SKIP(metres, "terrain/autzen/ortho_0.3m_utm10.tif");
  OVERFLY_DATA_OR_SKIP(feet, "terrain/autzen/ortho_epsg2994_ft.tif");
  OVERFLY_DATA_OR_SKIP(jpeg, "terrain/autzen/autzen.jpg");
  OVERFLY_DATA_OR_SKIP(posts, "terrain/autzen/dtm_3m_utm10.tif");
  const terrain::World a = opened(metres, posts);
  const Geodetic origin = a.tiles->frame().origin();
  const terrain::World b = opened(feet, posts, origin);
  // The published picture has a world file but does not name its coordinate system.
  const terrain::World c = opened(jpeg, posts, origin, "EPSG:2994");
  for (const double height_m : {150.0, 300.0}) {
    const Pose pose = above(a, height_m);
    const Picture in_a = draw(a, pose);
    const Picture in_b = draw(b, pose);
    const Picture in_c = draw(c, pose);
    EXPECT_GE(psnr_db(in_a.rgb, in_b.rgb), 40.0) << height_m;
    EXPECT_GE(psnr_db(in_b.rgb, in_c.rgb), 40.0) << height_m;
  }
}

TEST(RealWorld, PicturesAreTheFilesOwnAtTheirPlace) {
  OVERFLY_DATA_OR_SKIP(autzen, "terrain/autzen/ortho_0.3m_utm10.tif");
  OVERFLY_DATA_OR_SKIP(autzen_posts, "terrain/autzen/dtm_3m_utm10.tif");
  OVERFLY_DATA_OR_SKIP(feet, "terrain/autzen/ortho_epsg2994_ft.tif");
  OVERFLY_DATA_OR_SKIP(mcmillan, "terrain/mcmillan/ortho_0.8m_utm10.tif");
  OVERFLY_DATA_OR_SKIP(goleta, "terrain/goleta/ortho_epsg4326.tif");
  OVERFLY_DATA_OR_SKIP(goleta_posts, "terrain/goleta/elevation_epsg4326.tif");
  expect_file_in_its_place(opened(autzen, autzen_posts), autzen, "EPSG:26910", 0.3, 50.0);
  expect_file_in_its_place(opened(feet, autzen_posts), feet, "EPSG:2994", 0.3048, 50.0);
  expect_file_in_its_place(opened(mcmillan, {}), mcmillan, "EPSG:32610", 0.816, 50.0);
  // In degrees: resampled once onto the map, by a sharper kernel than the bilinear one here.
  expect_file_in_its_place(opened(goleta, goleta_posts), goleta, "EPSG:4326", 2.8, 33.0);
}

/// Ground that a picture's depth shows, against the file's heights.
void expect_heights(const fs::path& posts,
                    const std::string& posts_crs,
                    double unit_m,
                    const std::string& crs,
                    double x,
                    double y) {
  TemporaryFolder folder;
  testing::GeoTiff tiff;
  tiff.image = testing::textured_image(400, 400, 3);
  tiff.crs = crs;
  tiff.pixel = 10.0;
  tiff.left = x - 2000.0;
  tiff.top = y + 2000.0;
  testing::write_geotiff(folder.path() / "image.tif", tiff);
  const terrain::World world = opened(folder.path() / "image.tif", posts);
  const Picture picture = draw(world, above(world, 2500.0));
  const IndependentElevation direct(posts, posts_crs);
  std::vector<double> errors_m;
  for (int y_px = 1; y_px < picture.rgb.height_px; y_px += 6) {
    for (int x_px = 1; x_px < picture.rgb.width_px; x_px += 6) {
      const Geodetic place = place_of(world, picture, x_px, y_px);
      const double value = direct.value_at(place.lat_rad, place.lon_rad);
      if (!std::isnan(value)) {
        errors_m.push_back(std::abs(place.alt_ellipsoid_m - value * unit_m));
      }
    }
  }
  ASSERT_GT(errors_m.size(), 4000U);
  std::sort(errors_m.begin(), errors_m.end());
  const double median_m = errors_m[errors_m.size() / 2];
  const double most_m = errors_m[errors_m.size() * 99 / 100];
  // The camera is drawn over triangles that stay within a quarter of a pixel (1.8 m) of the posts.
  EXPECT_LT(median_m, 0.2);
  EXPECT_LT(most_m, 1.8);
}

TEST(RealWorld, DepthShowsTheHeightsOfAnHgtTileAndANativeDem) {
  OVERFLY_DATA_OR_SKIP(hgt, "terrain/elevation_formats/N44W072.hgt");
  OVERFLY_DATA_OR_SKIP(dem, "terrain/elevation_formats/mtsthelens_after_usgs.dem");
  expect_heights(hgt, "EPSG:4326", 1.0, "EPSG:32619", 301290.0, 4930250.0);
  expect_heights(dem, "EPSG:26710", 0.3048, "EPSG:26910", 562710.0, 5114985.0);
}

}  // namespace
}  // namespace overfly::renderer
