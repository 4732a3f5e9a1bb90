// Downloads from a server on the loopback that answers as the services do.
#include "terrain/download.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/motion/pose.hpp"
#include "terrain/world.hpp"
#include "tests/terrain/download/download_fixture.hpp"

namespace overfly::terrain {
namespace {

using testing::answer_rightly;
using testing::expect_right_places;
using testing::HttpAnswer;
using testing::HttpRequest;
using testing::LocalHttpServer;
using testing::words;

class Download : public testing::DownloadFixture {};

TEST_F(Download, MakesAWorldThatOpensInTheRightPlace) {
  const LocalHttpServer server([](const HttpRequest& request) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));  // so that requests overlap
    return answer_rightly(request);
  });
  double last_share = 0.0;
  const auto report = download_world(options_for(server), [&](double share, const std::string&) {
    EXPECT_GE(share, last_share);
    last_share = share;
    return true;
  });
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->fetched, 5);
  EXPECT_TRUE(report->warnings.empty());
  EXPECT_EQ(server.most_at_a_time(), 2);
  EXPECT_FALSE(std::filesystem::exists(folder() / "world" / "chunks"));
  expect_right_places(report->manifest);
  const std::string manifest = testing::read_text(report->manifest);
  EXPECT_NE(manifest.find("USDA NAIP imagery, USGS The National Map (Test Survey)"),
            std::string::npos);
  EXPECT_NE(manifest.find("\"navd88\""), std::string::npos);
}

TEST_F(Download, NamesItselfToTheService) {
  std::mutex mutex;
  std::string agent;
  const LocalHttpServer server([&](const HttpRequest& request) {
    const std::lock_guard lock(mutex);
    agent = request.user_agent;
    return answer_rightly(request);
  });
  ASSERT_TRUE(plan_download(options_for(server)));
  EXPECT_EQ(agent.rfind("Overfly/", 0), 0U) << agent;
}

TEST_F(Download, PlansWithoutFetchingAnImage) {
  const LocalHttpServer server([](const HttpRequest& request) {
    if (request.path.find("exportImage") != std::string::npos)
      ADD_FAILURE() << "an image was asked";
    return answer_rightly(request);
  });
  const auto plan = plan_download(options_for(server));
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->layers.size(), 2U);
  EXPECT_EQ(plan->layers[0].requests.size(), 4U);
  EXPECT_EQ(plan->layers[0].width_px, 501);
  EXPECT_EQ(plan->layers[0].transfer_bytes, 3U * 501U * 501U);
  EXPECT_EQ(plan->layers[1].width_px, 91);
  EXPECT_EQ(plan->layers[0].crs, "EPSG:26916");
  EXPECT_NE(plan->layers[0].requests[0].url.find("&size=300,300&"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder() / "world"));
}

TEST_F(Download, AssumesLimitsWhereTheServiceCannotBeAsked) {
  DownloadOptions options;
  {
    const LocalHttpServer gone(answer_rightly);
    options = options_for(gone);
  }
  const auto plan = plan_download(options);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->warnings.size(), 2U);
}

TEST_F(Download, FollowsRedirects) {
  const LocalHttpServer server([](const HttpRequest& request) {
    if (request.path.rfind("/moved", 0) == 0 || !request.query.contains("bbox")) {
      return answer_rightly(request);
    }
    HttpAnswer moved = words(302, "text/html", "");
    std::string query;
    for (const auto& [name, value] : request.query)
      query += (query.empty() ? "?" : "&") + name + "=" + value;
    moved.headers.push_back("Location: /moved" + request.path + query);
    return moved;
  });
  const auto report = download_world(options_for(server));
  ASSERT_TRUE(report) << report.error().message;
  expect_right_places(report->manifest);
}

TEST_F(Download, CountsRowsAsTheTemplateDoes) {
  // The same tile by the numbers of XYZ, of TMS (rows from the south) and of WMTS.
  const LocalHttpServer server(answer_rightly);
  DownloadOptions options = options_for(server);
  options.imagery_attribution = "Test tiles";
  options.elevation_source = kNoSource;
  options.ground_height_m = 180.0;
  const auto first_url = [&](const std::string& source) {
    options.imagery_source = server.address() + source;
    const auto plan = plan_download(options);
    EXPECT_TRUE(plan) << plan.error().message;
    return plan ? plan->layers[0].requests[0].url.substr(server.address().size()) : std::string();
  };
  int z = 0, x = 0, y = 0, from_south = 0;
  ASSERT_EQ(std::sscanf(first_url("/{z}/{x}/{y}.png").c_str(), "/%d/%d/%d.png", &z, &x, &y), 3);
  ASSERT_EQ(std::sscanf(first_url("/{-y}/{z}/{x}").c_str(), "/%d/%d/%d", &from_south, &z, &x), 3);
  EXPECT_EQ(from_south, (1 << z) - 1 - y);
  EXPECT_EQ(first_url("/wmts?Service=WMTS&Request=GetTile&TileMatrix={TileMatrix}&"
                      "TileRow={TileRow}&TileCol={TileCol}"),
            "/wmts?Service=WMTS&Request=GetTile&TileMatrix=" + std::to_string(z) +
                "&TileRow=" + std::to_string(y) + "&TileCol=" + std::to_string(x));
}

TEST_F(Download, DoesNotMixTwoDownloadsInOneFolder) {
  const LocalHttpServer server(answer_rightly);
  DownloadOptions options = options_for(server);
  ASSERT_TRUE(download_world(options));
  options.imagery_m = 2.0;
  const auto other = download_world(options);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::kConflict);
}

TEST_F(Download, TakesTilesOfATemplateToTheirPlace) {
  const LocalHttpServer server([](const HttpRequest& request) {
    int z = 0, x = 0, y = 0;
    if (std::sscanf(request.path.c_str(), "/tiles/%d/%d/%d.png", &z, &x, &y) != 3) {
      return words(400, "text/plain", request.path);
    }
    // Two tiles are not there, as beyond the edge of a survey.
    static std::atomic<int> asked{0};
    const int before = asked++;
    if (before == 0) return words(404, "text/plain", "no tile");
    if (before == 1) return words(204, "image/png", "");
    return testing::picture_tile(z, x, y);
  });
  DownloadOptions options = options_for(server);
  options.imagery_source = server.address() + "/tiles/{z}/{x}/{y}.png";
  options.imagery_attribution = "Test tiles";
  options.elevation_source = kNoSource;
  options.ground_height_m = 180.0;
  options.parallel = 1;
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->absent, 2);
  EXPECT_EQ(report->repeated, 0);
  auto spec = read_world_manifest(report->manifest);
  ASSERT_TRUE(spec);
  const auto world = open_world(*spec);
  ASSERT_TRUE(world) << world.error().message;
  // 1 m needs zoom 17 at this latitude: 156543 m / 2^17 * cos 39.35 = 0.92 m. The tile at the
  // centre, by the formulas of the slippy map: x = (lon + 180) / 360 2^z,
  // y = (1 - asinh(tan lat) / pi) / 2 2^z.
  const int zoom = 17;
  const double n = 1 << zoom;
  const int x = static_cast<int>((-86.03 + 180.0) / 360.0 * n);
  const int y = static_cast<int>((1.0 - std::asinh(std::tan(rad_from_deg(39.35))) / kPi) / 2.0 * n);
  const Eigen::Vector3d centre =
      world->tiles->frame().world_from_geodetic(geodetic_from_deg(39.35, -86.03, 180.0));
  const Eigen::Vector2d map = world->tiles->map_from_world(centre.x(), centre.y());
  const TileGrid& grid = world->tiles->grid();
  const int column = static_cast<int>((map.x() - grid.left_x_m) / grid.texel_m);
  const int row = static_cast<int>((grid.top_y_m - map.y()) / grid.texel_m);
  const auto tile = world->tiles->tile({0, column / kTileTexels, row / kTileTexels});
  ASSERT_TRUE(tile);
  const int px = column % kTileTexels + kTileBorder;
  const int py = row % kTileTexels + kTileBorder;
  EXPECT_EQ(tile->rgb.at(px, py, 0), zoom);
  EXPECT_EQ(tile->rgb.at(px, py, 1), x & 255);
  EXPECT_EQ(tile->rgb.at(px, py, 2), y & 255);
  EXPECT_NE(world->tiles->coverage({0, 0, 0}), TileCoverage::kFull);
}

TEST_F(Download, AsksAWebMapServiceByItsTemplate) {
  std::mutex mutex;
  std::vector<std::string> boxes;
  const LocalHttpServer server([&](const HttpRequest& request) {
    const std::lock_guard lock(mutex);
    boxes.push_back(request.query.at("BBOX"));
    return testing::picture_tile(1, 2, 3, std::stoi(request.query.at("WIDTH")));
  });
  DownloadOptions options = options_for(server);
  options.imagery_source =
      server.address() + "/wms?BBOX={bbox}&WIDTH={width}&HEIGHT={height}&CRS={crs}";
  options.imagery_attribution = "Test map";
  options.elevation_source = kNoSource;
  options.size_m = 200.0;
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(boxes.size(), 1U);
  double box[4] = {};
  ASSERT_EQ(std::sscanf(boxes[0].c_str(), "%lf,%lf,%lf,%lf", box, box + 1, box + 2, box + 3), 4);
  // The centre in EPSG:3857.
  const double x = 6378137.0 * rad_from_deg(-86.03);
  const double y = 6378137.0 * std::asinh(std::tan(rad_from_deg(39.35)));
  EXPECT_NEAR(0.5 * (box[0] + box[2]), x, 2.0);
  EXPECT_NEAR(0.5 * (box[1] + box[3]), y, 2.0);
  EXPECT_NEAR((box[2] - box[0]) * std::cos(rad_from_deg(39.35)), 200.0, 2.0);
}

/// A square of Fiji whose middle lies 10 m west of the antimeridian.
DownloadOptions across_the_antimeridian(DownloadOptions options) {
  options.center_lat_rad = rad_from_deg(-16.8);
  options.center_lon_rad = rad_from_deg(179.9999);
  options.imagery_attribution = "Test map";
  options.elevation_source = kNoSource;
  options.ground_height_m = 60.0;
  options.size_m = 600.0;
  return options;
}

TEST_F(Download, TakesTilesFromBothSidesOfTheAntimeridian) {
  const LocalHttpServer server([](const HttpRequest& request) {
    int z = 0, x = 0, y = 0;
    if (std::sscanf(request.path.c_str(), "/tiles/%d/%d/%d.png", &z, &x, &y) != 3 || x < 0 ||
        x >= 1 << z) {
      return words(400, "text/plain", request.path);
    }
    return testing::picture_tile(z, x, y);
  });
  DownloadOptions options = across_the_antimeridian(options_for(server));
  options.imagery_source = server.address() + "/tiles/{z}/{x}/{y}.png";
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  const auto world = open_world(read_world_manifest(report->manifest).value());
  ASSERT_TRUE(world) << world.error().message;
  const TileGrid& grid = world->tiles->grid();
  for (const double lon_deg : {179.998, -179.998}) {
    const Eigen::Vector3d p =
        world->tiles->frame().world_from_geodetic(geodetic_from_deg(-16.8, lon_deg, 60.0));
    const Eigen::Vector2d map = world->tiles->map_from_world(p.x(), p.y());
    const int column = static_cast<int>((map.x() - grid.left_x_m) / grid.texel_m);
    const int row = static_cast<int>((grid.top_y_m - map.y()) / grid.texel_m);
    const auto tile = world->tiles->tile({0, column / kTileTexels, row / kTileTexels});
    ASSERT_TRUE(tile);
    const int u = column % kTileTexels + kTileBorder;
    const int v = row % kTileTexels + kTileBorder;
    const int zoom = tile->rgb.at(u, v, 0);
    const int x = static_cast<int>((lon_deg + 180.0) / 360.0 * (1 << zoom));
    EXPECT_EQ(tile->rgb.at(u, v, 1), x & 255) << lon_deg << " at zoom " << zoom;
  }
}

TEST_F(Download, AsksAWebMapServiceOnBothSidesOfTheAntimeridian) {
  const LocalHttpServer server([](const HttpRequest&) { return words(500, "text/plain", ""); });
  DownloadOptions options = across_the_antimeridian(options_for(server));
  options.imagery_source = server.address() + "/wms?{bbox}&{width}&{height}";
  const auto plan = plan_download(options);
  ASSERT_TRUE(plan) << plan.error().message;
  constexpr double kEnd = 20037508.342789244;
  double width = 0.0;
  for (const DownloadRequest& request : plan->layers.front().requests) {
    double left = 0.0, bottom = 0.0, right = 0.0, top = 0.0;
    const std::size_t at = request.url.find('?') + 1;
    ASSERT_EQ(
        std::sscanf(request.url.c_str() + at, "%lf,%lf,%lf,%lf", &left, &bottom, &right, &top), 4);
    // A pixel may straddle the seam.
    EXPECT_GE(left, -kEnd - 2.0) << request.url;
    EXPECT_LE(right, kEnd + 2.0) << request.url;
    width += right - left;
  }
  EXPECT_EQ(plan->layers.front().requests.size(), 2U);
  EXPECT_NEAR(width * std::cos(rad_from_deg(-16.8)), 600.0, 4.0);
}

TEST_F(Download, RefusesWhatCannotBeMeant) {
  DownloadOptions options;
  options.folder = folder() / "world";
  const auto message = [&] {
    const auto plan = plan_download(options);
    return plan ? std::string("accepted") : plan.error().message;
  };
  options.size_m = 5.0;
  EXPECT_NE(message().find("size_m = 5"), std::string::npos);
  options.size_m = 4000.0;
  options.imagery_source = "https://example.org/{z}/{x}.png";
  options.imagery_attribution = "x";
  EXPECT_NE(message().find("must contain {z} {x} {y}"), std::string::npos);
  options.imagery_source = "https://example.org/{z}/{x}/{y}.png";
  options.imagery_attribution.clear();
  EXPECT_NE(message().find("attribution"), std::string::npos);
  options.imagery_attribution = "x";
  options.elevation_source = kNoSource;
  options.size_m = 50e3;
  options.most_requests = 1000;
  EXPECT_NE(message().find("limit 1000"), std::string::npos) << message();
}

}  // namespace
}  // namespace overfly::terrain
