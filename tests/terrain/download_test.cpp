// Downloads from a server on the loopback that answers as the services do, errors included.
#include "terrain/download.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/pose.hpp"
#include "terrain/download/http_get.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/image_service.hpp"
#include "tests/terrain/local_http_server.hpp"

namespace overfly::terrain {
namespace {

using testing::HttpAnswer;
using testing::HttpRequest;
using testing::LocalHttpServer;
using testing::TemporaryFolder;

HttpAnswer answer_rightly(const HttpRequest& request) {
  if (request.path.find("/exportImage") != std::string::npos) return testing::export_image(request);
  return testing::image_service_description(300);
}

HttpAnswer words(int status, const std::string& type, const std::string& body) {
  HttpAnswer answer;
  answer.status = status;
  answer.content_type = type;
  answer.body = body;
  return answer;
}

/// Counts how often each address was asked.
class Counter {
 public:
  int operator()(const HttpRequest& request) {
    const std::lock_guard lock(mutex_);
    return ++counts_[request.path +
                     (request.query.contains("bbox") ? request.query.at("bbox") : "")];
  }

 private:
  std::mutex mutex_;
  std::map<std::string, int> counts_;
};

class Download : public ::testing::Test {
 protected:
  /// 600 m in southern Indiana at 1 m: four requests of imagery, one of elevation.
  [[nodiscard]] DownloadOptions options_for(const LocalHttpServer& server) const {
    DownloadOptions options;
    options.center_lat_rad = rad_from_deg(39.35);
    options.center_lon_rad = rad_from_deg(-86.03);
    options.size_m = 500.0;
    options.imagery_m = 1.0;
    options.elevation_m = 10.0;
    options.elevation_margin_m = 200.0;
    options.folder = folder_.path() / "world";
    options.imagery_service = server.address() + "/naip/ImageServer";
    options.elevation_service = server.address() + "/3dep/ImageServer";
    options.first_wait_s = 0.01;
    options.stall_s = 5.0;
    return options;
  }
  /// The message of a download that must fail.
  [[nodiscard]] std::string failure(const LocalHttpServer::Handler& handler) const {
    const LocalHttpServer server(handler);
    DownloadOptions options = options_for(server);
    options.attempts = 2;
    const auto report = download_world(options);
    EXPECT_FALSE(report) << "the download was accepted";
    EXPECT_FALSE(std::filesystem::exists(options.folder / "world.json"));
    EXPECT_FALSE(std::filesystem::exists(options.folder / "imagery.tif"));
    return report ? std::string() : report.error().message;
  }
  TemporaryFolder folder_;
};

/// Every texel and height of a downloaded world is that of its place.
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

TEST_F(Download, MakesAWorldThatOpensInTheRightPlace) {
  const LocalHttpServer server(answer_rightly);
  double last_share = 0.0;
  const auto report = download_world(options_for(server), [&](double share, const std::string&) {
    EXPECT_GE(share, last_share);
    last_share = share;
    return true;
  });
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->fetched, 5);
  EXPECT_TRUE(report->warnings.empty());
  EXPECT_LE(server.most_at_a_time(), 2);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "world" / "chunks"));
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
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "world"));
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

TEST_F(Download, RepeatsWhatMayPass) {
  // Every address fails once, each in one of the ways services have.
  Counter count;
  std::atomic<int> kind{0};
  const LocalHttpServer server([&](const HttpRequest& request) {
    if (count(request) > 1 || request.path.find("exportImage") == std::string::npos) {
      return answer_rightly(request);
    }
    switch (kind++ % 5) {
      case 0:
        return words(503, "text/html", "<html><title>busy</title></html>");
      case 1:
        return words(200, "application/json", R"({"error":{"code":500,"message":"Error"}})");
      case 2:
        return words(200, "text/html", "<html><title>Sorry</title></html>");
      case 3: {
        HttpAnswer cut = answer_rightly(request);
        cut.cut_after = cut.body.size() / 2;
        return cut;
      }
      default: {
        HttpAnswer cut = answer_rightly(request);  // a cut that the length does not betray
        cut.body.resize(cut.body.size() / 2);
        return cut;
      }
    }
  });
  const auto report = download_world(options_for(server));
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->repeated, 5);
  expect_right_places(report->manifest);
}

TEST_F(Download, WaitsAsLongAsTheServiceAsks) {
  Counter count;
  const LocalHttpServer server([&](const HttpRequest& request) {
    if (request.query.contains("bbox") && count(request) == 1) {
      HttpAnswer busy = words(429, "text/plain", "slow down");
      busy.headers.emplace_back("Retry-After: 1");
      return busy;
    }
    return answer_rightly(request);
  });
  DownloadOptions options = options_for(server);
  options.elevation_source = kNoSource;
  options.ground_height_m = 200.0;
  options.size_m = 200.0;
  const auto start = std::chrono::steady_clock::now();
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->repeated, 1);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(990));
}

TEST_F(Download, GivesUpWhereTheServiceAsksForMoreThanTheLimit) {
  const std::string message = failure([](const HttpRequest& request) {
    if (!request.query.contains("bbox")) return answer_rightly(request);
    HttpAnswer busy = words(503, "text/plain", "maintenance");
    busy.headers.emplace_back("Retry-After: 7200");
    return busy;
  });
  EXPECT_NE(message.find("asks to wait 7200 s, limit 300 s"), std::string::npos) << message;
}

TEST_F(Download, ReadsARetryDate) {
  EXPECT_EQ(download::retry_after_s("120", 0), 120.0);
  // RFC 9110's example date is 784111777 s after the epoch.
  EXPECT_EQ(download::retry_after_s("Sun, 06 Nov 1994 08:49:37 GMT", 784111777 - 30), 30.0);
  EXPECT_FALSE(download::retry_after_s("soon", 0));
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

TEST_F(Download, SaysWhatIsWrongWithAnAnswer) {
  struct Case {
    const char* expected;
    LocalHttpServer::Handler image;
  };
  const auto changed = [](const HttpRequest& request, const char* field, const std::string& value) {
    HttpRequest other = request;
    other.query[field] = value;
    return testing::export_image(other);
  };
  const Case cases[] = {
      {"code 400, \"Invalid bbox\" (attempt 2 of 2)",
       [](const HttpRequest&) {
         return words(
             200, "application/json", R"({"error":{"code":400,"message":"Invalid bbox"}})");
       }},
      {"HTTP status 403", [](const HttpRequest&) { return words(403, "text/plain", "no"); }},
      {"HTTP status 404", [](const HttpRequest&) { return words(404, "text/plain", "no"); }},
      {"the service answers in words: Sorry",
       [](const HttpRequest&) {
         return words(200, "text/html", "<html><title>Sorry</title></html>");
       }},
      {"asked for 300 x 300",
       [&](const HttpRequest& request) { return changed(request, "size", "256,256"); }},
      {"has the coordinate reference system",
       [&](const HttpRequest& request) { return changed(request, "imageSR", "26917"); }},
      {"lies elsewhere",
       [&](const HttpRequest& request) {
         return changed(request, "bbox", "583000,4356000,583300,4356300");
       }},
      {"asked for 8 bit",
       [&](const HttpRequest& request) { return changed(request, "pixelType", "F32"); }},
      {"no image that can be read",
       [](const HttpRequest&) { return words(200, "image/tiff", "II*\1garbage"); }},
  };
  for (const Case& wrong : cases) {
    const std::string message = failure([&](const HttpRequest& request) {
      return request.path == "/naip/ImageServer/exportImage" ? wrong.image(request)
                                                             : answer_rightly(request);
    });
    EXPECT_NE(message.find(wrong.expected), std::string::npos) << message;
    EXPECT_NE(message.find("/naip/ImageServer/exportImage?bbox="), std::string::npos) << message;
    std::filesystem::remove_all(folder_.path() / "world");
  }
}

TEST_F(Download, GoesOnWhereItStopped) {
  std::atomic<int> images{0};
  std::atomic<bool> broken{true};
  const LocalHttpServer server([&](const HttpRequest& request) {
    if (!request.query.contains("bbox")) return answer_rightly(request);
    if (broken.load() && ++images > 3) return words(500, "text/plain", "down");
    return answer_rightly(request);
  });
  DownloadOptions options = options_for(server);
  options.attempts = 1;
  options.parallel = 1;
  ASSERT_FALSE(download_world(options));
  // One of the three chunks is damaged on the disk meanwhile, and a part of one lies about.
  const std::filesystem::path chunks = options.folder / "chunks";
  ASSERT_TRUE(std::filesystem::exists(chunks / "imagery_0_0.tif"));
  std::filesystem::resize_file(chunks / "imagery_0_0.tif", 5000);
  std::ofstream(chunks / "imagery_300_300.tif.part") << "half";
  broken.store(false);
  const auto report = download_world(options);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->reused, 2);
  EXPECT_EQ(report->fetched, 3);
  expect_right_places(report->manifest);
  // Asked again, there is nothing left to do.
  const int before = server.requests();
  ASSERT_TRUE(download_world(options));
  EXPECT_EQ(server.requests() - before, 2) << "only the services' limits are asked";
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

TEST_F(Download, StopsWhenToldTo) {
  const LocalHttpServer server([](const HttpRequest& request) {
    if (request.query.contains("bbox")) std::this_thread::sleep_for(std::chrono::milliseconds(300));
    return answer_rightly(request);
  });
  int calls = 0;
  const auto report =
      download_world(options_for(server), [&](double, const std::string&) { return ++calls < 2; });
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kCancelled);
}

TEST_F(Download, TakesTilesOfATemplateToTheirPlace) {
  const LocalHttpServer server([](const HttpRequest& request) {
    int z = 0, x = 0, y = 0;
    if (std::sscanf(request.path.c_str(), "/tiles/%d/%d/%d.png", &z, &x, &y) != 3) {
      return words(400, "text/plain", request.path);
    }
    // One tile is not there, as beyond the edge of a survey.
    static std::atomic<bool> first{true};
    if (first.exchange(false)) return words(404, "text/plain", "no tile");
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
  EXPECT_EQ(report->absent, 1);
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

TEST_F(Download, RefusesWhatCannotBeMeant) {
  DownloadOptions options;
  options.folder = folder_.path() / "world";
  const auto message = [&] {
    const auto plan = plan_download(options);
    return plan ? std::string("accepted") : plan.error().message;
  };
  options.size_m = 5.0;
  EXPECT_NE(message().find("size_m = 5"), std::string::npos);
  options.size_m = 4000.0;
  options.imagery_source = "https://example.org/{z}/{x}.png";
  options.imagery_attribution = "x";
  EXPECT_NE(message().find("must hold {z} {x} {y}"), std::string::npos);
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
