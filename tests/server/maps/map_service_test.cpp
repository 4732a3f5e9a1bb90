// The worlds of a server by name, their tiles and heights.
#include "server/maps/map_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/pose.hpp"
#include "server/maps/world_list.hpp"
#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class MapServiceTest : public testing::ManagerTest {
 protected:
  MapServiceTest() {
    RunManagerOptions confined = options();
    confined.data_folders = {testing::small_world().parent_path()};
    runs_ = std::move(RunManager::create(confined).value());
  }

  [[nodiscard]] static std::string file_name() {
    const fs::path& world = testing::small_world();
    return "file:" + world.parent_path().filename().string() + "/" + world.filename().string();
  }
  /// A tile in the middle of the small world, all of it imagery.
  static MapTileId middle_tile(const nlohmann::json& description) {
    const nlohmann::json& centre = description.at("centre");
    const int zoom = description.at("max_zoom").get<int>() + 1;
    const Eigen::Vector2d at = mercator_from_geodetic(rad_from_deg(centre.at("lat_deg")),
                                                      rad_from_deg(centre.at("lon_deg"))) *
                               std::ldexp(1.0, zoom);
    return {zoom, static_cast<int>(at.x()), static_cast<int>(at.y())};
  }

  std::unique_ptr<RunManager> runs_;
};

TEST_F(MapServiceTest, ListsEachWorldOnce) {
  const WorldList list = list_worlds(*runs_);
  EXPECT_TRUE(list.complete);
  ASSERT_EQ(list.worlds.size(), 2U);
  EXPECT_EQ(list.worlds[0].name, "builtin:1");
  EXPECT_EQ(list.worlds[1].name, file_name());
  EXPECT_EQ(list.worlds[1].world.at("manifest"), testing::small_world().string());
  EXPECT_EQ(list.worlds[1].scenarios, std::vector<std::string>{"small"});
  EXPECT_TRUE(list.worlds[0].scenarios.empty());
  // A scenario over it can be flown.
  const auto scenario = scenario_over(*runs_, file_name());
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
}

TEST_F(MapServiceTest, KnowsNoOtherWorlds) {
  for (const std::string& name :
       {std::string("builtin:x"),
        std::string("builtin:-1"),
        std::string("file:none/world.json"),
        std::string("file:../world.json"),
        std::string("file:/etc/passwd"),
        std::string("scenario:none"),
        std::string("scenario:../small"),
        std::string("small"),
        "file:" + testing::small_world().parent_path().filename().string() +
            "/../scenarios/small.json"}) {
    const auto scenario = scenario_over(*runs_, name);
    ASSERT_FALSE(scenario.ok()) << name;
    EXPECT_EQ(scenario.error().code, ErrorCode::kNotFound) << name;
  }
}

TEST_F(MapServiceTest, DescribesAWorld) {
  MapService maps(*runs_);
  const auto described = maps.describe(file_name(), {});
  ASSERT_TRUE(described.ok()) << described.error().message;
  const nlohmann::json& centre = described->at("centre");
  const nlohmann::json& bounds = described->at("bounds");
  EXPECT_LT(bounds.at("south_deg"), centre.at("lat_deg"));
  EXPECT_GT(bounds.at("north_deg"), centre.at("lat_deg"));
  EXPECT_LT(bounds.at("west_deg"), centre.at("lon_deg"));
  EXPECT_GT(bounds.at("east_deg"), centre.at("lon_deg"));
  EXPECT_EQ(described->at("version").get<std::string>().size(), 16U);
  // EGM96 at the default place of synthetic worlds (39.35 N, 86.03 W): -33 m.
  EXPECT_NEAR(described->at("sea_level_ellipsoid_m").get<double>(), -33.0, 4.0);
  EXPECT_LE(described->at("min_zoom"), described->at("max_zoom"));
}

TEST_F(MapServiceTest, DrawsTilesAndKeepsThem) {
  MapService maps(*runs_);
  const nlohmann::json described = maps.describe(file_name(), {}).value();
  const MapTileId id = middle_tile(described);
  const auto tile = maps.tile(file_name(), id, {});
  ASSERT_TRUE(tile.ok()) << tile.error().message;
  EXPECT_STREQ(tile->content_type, "image/jpeg");
  EXPECT_EQ(tile->version, described.at("version"));
  EXPECT_EQ(maps.tile(file_name(), id, [] { return true; })->bytes, tile->bytes);
  const auto beside = maps.tile(file_name(), {id.zoom, 0, 0}, {});
  EXPECT_STREQ(beside->content_type, "image/png");
  for (const MapTileId& none : {MapTileId{-1, 0, 0}, {25, 0, 0}, {3, 8, 0}, {3, 0, -1}}) {
    EXPECT_EQ(maps.tile(file_name(), none, {}).error().code, ErrorCode::kInvalidArgument);
  }
  EXPECT_EQ(maps.tile("file:none/a.json", id, {}).error().code, ErrorCode::kNotFound);
}

TEST_F(MapServiceTest, HasAnotherVersionForEveryChangeOfTheWorld) {
  MapService maps(*runs_);
  const auto opened = maps.open(file_name(), {}).value()->opened();
  ASSERT_FALSE(opened->files.empty());
  const auto version = [](const OpenedWorld& world, const std::string& key) {
    return MapWorld(std::make_shared<const OpenedWorld>(world), key).version();
  };
  const std::string first = version(*opened, "a");
  EXPECT_EQ(version(*opened, "a"), first);
  EXPECT_NE(version(*opened, "b"), first) << "another coordinate system or void, for instance";
  OpenedWorld changed = *opened;
  terrain::WorldFile& file = changed.files.front();
  ASSERT_TRUE(file.identity);
  ++file.identity->changed_ns;
  EXPECT_NE(version(changed, "a"), first);
  file.identity.reset();
  EXPECT_NE(version(changed, "a"), first);
}

TEST_F(MapServiceTest, MeasuresTheGround) {
  MapService maps(*runs_);
  const auto world = maps.open(file_name(), {});
  ASSERT_TRUE(world.ok());
  const terrain::TileSource& tiles = (*world)->tiles();
  std::vector<Geodetic> points;
  for (const double east : {-20.0, 0.0, 30.0}) {
    points.push_back(
        tiles.frame().geodetic_from_world({east, 10.0, tiles.ground_up_m(east, 10.0)}));
  }
  const Geodetic far = geodetic_from_deg(10.0, 10.0, 0.0);
  points.push_back(far);
  const auto heights = maps.heights(file_name(), points, {});
  ASSERT_TRUE(heights.ok());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR((*heights)[i].alt_ellipsoid_m, points[i].alt_ellipsoid_m, 1e-2);
    EXPECT_TRUE((*heights)[i].imagery);
  }
  EXPECT_FALSE((*heights)[3].imagery);
  EXPECT_EQ(maps.heights(file_name(), points, [] { return true; }).error().code,
            ErrorCode::kCancelled);
}

TEST_F(MapServiceTest, MakesTheBuiltInWorldOnlyWhenAsked) {
  const overfly::testing::TemporaryFolder cache;
  ::setenv("OVERFLY_CACHE", cache.path().c_str(), 1);
  MapService maps(*runs_);
  const auto described = maps.describe("builtin:5", {});
  EXPECT_EQ(described.error().code, ErrorCode::kConflict);
  int calls = 0;
  const auto cancelled = maps.describe(
      "builtin:5", [&] { return ++calls > 1; }, [](double) {});
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
  ::unsetenv("OVERFLY_CACHE");
}

}  // namespace
}  // namespace overfly::server
