// Flight logs as the truth of a scenario.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/text/number_text.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/camera/truth.hpp"
#include "server/worlds/scenario_world.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

using ::testing::HasSubstr;
using testing::small_scenario;

/// A mapping of a level flight to the north at 20 m/s for 10 s, near the equator.
class LogTruth : public ::testing::Test {
 protected:
  LogTruth() {
    std::string gps = "t,lat,lon,alt,roll,pitch,yaw\n";
    for (int i = 0; i <= 100; ++i) {
      gps += number_text(0.1 * i) + ',' + number_text(1.0 + 1.8087e-5 * i) + ",2,100,0,0,0\n";
    }
    overfly::testing::write_text(folder_.path() / "gps.csv", gps);
    overfly::testing::write_text(file("log.json"), R"({"csv_mapping_version": 1, "pieces": [
      {"name": "GPS", "file": "gps.csv", "origin": "gps", "time": {"column": "t", "unit": "s"},
       "columns": {"lat": {"column": "lat", "unit": "deg"}, "lon": {"column": "lon", "unit": "deg"},
                   "alt_msl": {"column": "alt", "unit": "m"},
                   "roll": {"column": "roll", "unit": "deg"},
                   "pitch": {"column": "pitch", "unit": "deg"},
                   "yaw": {"column": "yaw", "unit": "deg"}}}]})");
    overfly::testing::write_text(file("poses.tum"), "0 0 0 300 0 0 0 1\n9 0 9 300 0 0 0 1\n");
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] Result<std::unique_ptr<TruthSource>> truth(const std::string& log) const {
    const Scenario scenario = small_scenario({"flight.log=" + log});
    const auto opened = open_scenario_world(scenario);
    if (!opened) return opened.error();
    return create_truth(scenario, opened->world);
  }

 private:
  overfly::testing::TemporaryFolder folder_;
};

TEST_F(LogTruth, WarnsOfHeightsAboveSeaLevel) {
  for (const bool given : {false, true}) {
    const auto flown = truth(R"({"file":")" + file("log.json") + '"' +
                             (given ? R"(,"geoid_separation_m":0})" : "}"));
    ASSERT_TRUE(flown.ok()) << flown.error().message;
    const std::vector<std::string> warnings = (*flown)->warnings();
    const auto warned = ::testing::Contains(HasSubstr("may be wrong by about"));
    EXPECT_THAT(warnings,
                given ? ::testing::Matcher<std::vector<std::string>>(::testing::Not(warned))
                      : ::testing::Matcher<std::vector<std::string>>(warned));
  }
}

TEST_F(LogTruth, IsMovedToTheCentreOfTheImagery) {
  const Scenario scenario =
      small_scenario({R"(flight.log={"file":")" + file("log.json") +
                      R"(","smooth":{},"rebase":{"lowest_agl_m":150,"turn_deg":90}})"});
  const auto opened = open_scenario_world(scenario);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  auto truth = create_truth(scenario, opened->world);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  double lowest_m = 1e9;
  for (std::int64_t t_ns = 0; t_ns <= 10 * kNsPerS; t_ns += kNsPerS / 5) {
    const auto state = (*truth)->state_at(t_ns);
    ASSERT_TRUE(state.ok() && *state);
    const Eigen::Vector3d p = (*state)->T_world_body.translation;
    EXPECT_NEAR((*state)->v_body_world_m_s.x(), 20.0, 0.2);  // to the east
    lowest_m = std::min(lowest_m, p.z() - opened->world.tiles->ground_up_m(p.x(), p.y()));
    if (t_ns != 5 * kNsPerS) continue;
    const terrain::TileGrid& grid = opened->world.tiles->grid();
    ASSERT_LT(grid.width_m, 0.9 * grid.cols * grid.tile_m(0));  // the tiles are padded
    const Eigen::Vector3d centre = opened->world.tiles->world_from_map(
        grid.left_x_m + 0.5 * grid.width_m, grid.top_y_m - 0.5 * grid.height_m);
    EXPECT_LT((p.head<2>() - centre.head<2>()).norm(), 0.5);
  }
  EXPECT_NEAR(lowest_m, 150.0, 0.5);
}

TEST_F(LogTruth, NamesFieldsThatDoNotApply) {
  const auto pose = truth(R"({"file":")" + file("poses.tum") + R"(","from_s":1})");
  ASSERT_FALSE(pose.ok());
  EXPECT_THAT(pose.error().message, HasSubstr("flight.log.from_s: applies to flight logs"));
  const auto log = truth(R"({"file":")" + file("log.json") + R"(","camera_poses":true})");
  ASSERT_FALSE(log.ok());
  EXPECT_THAT(log.error().message, HasSubstr("flight.log.camera_poses = true: applies to pose"));
  const auto source = truth(R"({"file":")" + file("log.json") + R"(","source":"XKF1"})");
  ASSERT_FALSE(source.ok());
  EXPECT_THAT(source.error().message, HasSubstr("flight.log: "));
  EXPECT_THAT(source.error().message, HasSubstr("source XKF1: must be one of"));
  EXPECT_TRUE(truth(R"({"file":")" + file("poses.tum") + "\"}").ok());
}

}  // namespace
}  // namespace overfly::server
