#include "tests/terrain/download/download_fixture.hpp"

#include <cmath>

#include "core/motion/pose.hpp"
#include "terrain/world.hpp"

namespace overfly::testing {

using namespace terrain;

HttpAnswer answer_rightly(const HttpRequest& request) {
  if (request.path.find("/exportImage") != std::string::npos) return export_image(request);
  return image_service_description(300);
}

HttpAnswer words(int status, const std::string& type, const std::string& body) {
  HttpAnswer answer;
  answer.status = status;
  answer.content_type = type;
  answer.body = body;
  return answer;
}

DownloadOptions DownloadFixture::options_for(const LocalHttpServer& server) const {
  return options_at(server.address());
}

DownloadOptions DownloadFixture::options_at(const std::string& address) const {
  DownloadOptions options;
  options.center_lat_rad = rad_from_deg(39.35);
  options.center_lon_rad = rad_from_deg(-86.03);
  options.size_m = 500.0;
  options.imagery_m = 1.0;
  options.elevation_m = 10.0;
  options.elevation_margin_m = 200.0;
  options.folder = folder_.path() / "world";
  options.imagery_service = address + "/naip/ImageServer";
  options.elevation_service = address + "/3dep/ImageServer";
  options.first_wait_s = 0.01;
  options.stall_s = 5.0;
  return options;
}

std::string DownloadFixture::failure(const LocalHttpServer::Handler& handler) const {
  const LocalHttpServer server(handler);
  DownloadOptions options = options_for(server);
  options.attempts = 2;
  options.parallel = 1;  // the first request's failure is the one reported
  const auto report = download_world(options);
  EXPECT_FALSE(report) << "the download was accepted";
  EXPECT_FALSE(std::filesystem::exists(options.folder / "world.json"));
  EXPECT_FALSE(std::filesystem::exists(options.folder / "imagery.tif"));
  return report ? std::string() : report.error().message;
}

void expect_right_places(const std::filesystem::path& manifest) {
  auto spec = read_world_manifest(manifest);
  ASSERT_TRUE(spec) << spec.error().message;
  for (ElevationLayer& layer : spec->elevation) layer.geoid_separation_m = -33.0;
  const auto world = open_world(*spec);
  ASSERT_TRUE(world) << world.error().message;
  const TileGrid& grid = world->tiles->grid();
  EXPECT_NEAR(grid.texel_m, 1.0, 1e-9);
  const auto tile = world->tiles->tile({0, 0, 0});
  ASSERT_TRUE(tile);
  int wrong = 0;
  for (int y = 0; y < 500; y += 7) {
    for (int x = 0; x < 500; x += 7) {
      const double east = grid.left_x_m + x + 0.5;
      const double north = grid.top_y_m - y - 0.5;
      wrong += tile->rgb.at(x + kTileBorder, y + kTileBorder, 0) !=
               (static_cast<int>(std::floor(east / 5.0)) & 255);
      wrong += tile->rgb.at(x + kTileBorder, y + kTileBorder, 1) !=
               (static_cast<int>(std::floor(north / 5.0)) & 255);
    }
  }
  EXPECT_EQ(wrong, 0);
  const double x = grid.left_x_m + 250.0;
  const double y = grid.top_y_m - 250.0;
  const Geodetic ground =
      world->tiles->frame().geodetic_from_world(world->tiles->world_from_map(x, y));
  // Posts 10 m apart of hills some km long: bilinear between them to 2 cm; heights less the geoid
  // separation, unless PROJ has the datum's own grid here.
  EXPECT_NEAR(ground.alt_ellipsoid_m, testing::service_height_m(x, y) - 33.0, 2.0);
  EXPECT_NEAR(deg_from_rad(ground.lat_rad), 39.35, 1e-4);
  EXPECT_NEAR(deg_from_rad(ground.lon_rad), -86.03, 1e-4);
}

}  // namespace overfly::testing
