// Reports of missions over level ground: figures in closed form, and every warning.
#include "server/missions/mission_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/motion/pose.hpp"
#include "server/missions/mission_report_json.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "tests/server/missions/level_world.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

constexpr double kSpeedMS = 25.0;

class MissionReportTest : public ::testing::Test {
 protected:
  /// An item at a place of the world frame.
  Json item(int command, double east_m, double north_m, double height_m, Json first = 0.0) const {
    const Geodetic at = world_.world().tiles->frame().geodetic_from_world({east_m, north_m, 0.0});
    return {{"type", "SimpleItem"},
            {"command", command},
            {"frame", 3},
            {"params",
             {std::move(first),
              0,
              0,
              nullptr,
              deg_from_rad(at.lat_rad),
              deg_from_rad(at.lon_rad),
              height_m}}};
  }
  Scenario scenario(const Json& items, const Json& camera = Json::object()) const {
    const Geodetic home = world_.world().tiles->frame().geodetic_from_world({0, -1500, 0});
    Json document = {{"format_version", 1},
                     {"world", {{"builtin", {{"seed", 1}}}}},
                     {"camera", camera},
                     {"flight",
                      {{"mission",
                        {{"airspeed_m_s", kSpeedMS},
                         {"plan",
                          {{"fileType", "Plan"},
                           {"mission",
                            {{"version", 2},
                             {"plannedHomePosition",
                              {deg_from_rad(home.lat_rad), deg_from_rad(home.lon_rad), 230.0}},
                             {"items", items}}}}}}}}}};
    return resolve_scenario(std::move(document), {}, "/").value();
  }
  MissionReport report(const Scenario& flown, const MissionRequest& request = {}) const {
    auto made = report_mission(flown, world_.world(), request);
    EXPECT_TRUE(made.ok()) << (made ? "" : made.error().message);
    return made ? std::move(*made) : MissionReport();
  }
  static std::vector<std::string> kinds(const MissionReport& report) {
    std::vector<std::string> found;
    for (const MissionWarning& warning : report.warnings) found.push_back(warning.kind);
    return found;
  }

  testing::LevelWorld world_;
};

TEST_F(MissionReportTest, FollowsTheClosedFormsOfLevelFlight) {
  const MissionReport made = report(scenario(Json::array({item(16, 0, 1400, 300)})));
  ASSERT_GT(made.samples.size(), 200U);
  const MissionSample& middle = made.samples[made.samples.size() / 2];
  const double focal = 640.0 / std::tan(rad_from_deg(84.872 / 2.0));
  EXPECT_NEAR(middle.clearance_m, 300.0, 1.5);
  EXPECT_NEAR(middle.state.ground_speed_m_s, kSpeedMS, 0.1);
  EXPECT_NEAR(middle.translation_px, focal * kSpeedMS / 31.0 / 300.0, 0.03);
  EXPECT_LT(middle.rotation_px, 0.1);
  EXPECT_NEAR(middle.texels_px.value(), 300.0 / focal / testing::LevelWorld::kTexelM, 0.01);
  EXPECT_NEAR(middle.overlap.value(), 1.0 - kSpeedMS * focal / 300.0 / 960.0, 0.005);
  EXPECT_EQ(middle.imagery, 1.0);
  EXPECT_EQ(middle.item, 1);
  EXPECT_NEAR(made.distance_m, 2900.0, 60.0);
  EXPECT_NEAR(made.duration_s, 2900.0 / kSpeedMS, 4.0);
  EXPECT_FALSE(made.samples.back().overlap.has_value());
  ASSERT_TRUE(made.start.has_value());
  EXPECT_TRUE(made.start->enough);
  EXPECT_LT(made.start->from_s, 2.0);
  EXPECT_NEAR(made.start->baseline(), made.start->length_m / 300.0, 0.02);
  EXPECT_LE(made.footprints.size(), kMaxFootprints);
  EXPECT_GT(made.footprints.size(), 20U);
}

TEST_F(MissionReportTest, PredictsTheBankOfTurns) {
  // A circle of 90 m, and a right angle with legs that leave room for the tightest turn.
  Json circle = item(18, 0, 600, 300, 2);
  circle["params"][2] = 90.0;
  const MissionReport made =
      report(scenario({item(16, 0, -600, 300), item(16, 600, -600, 300), circle}));
  ASSERT_EQ(made.places.size(), 3U);
  const double g = 9.801;  // normal gravity at 39.35 deg of latitude
  EXPECT_EQ(made.places[2].turn_radius_m, 90.0);
  EXPECT_NEAR(made.places[2].turn_bank_deg.value(),
              deg_from_rad(std::atan(kSpeedMS * kSpeedMS / (g * 90.0))),
              0.1);
  EXPECT_NEAR(made.places[0].turn_bank_deg.value(), made.roll_limit_deg, 0.1);
  double circling = 0.0;
  for (const MissionSample& sample : made.samples) {
    if (sample.item == 3) circling = std::max(circling, sample.state.attitude.roll_rad);
  }
  EXPECT_NEAR(deg_from_rad(circling), made.places[2].turn_bank_deg.value(), 8.0);
  EXPECT_EQ(made.places[0].number, 1);
  EXPECT_NEAR(made.places[0].height_agl_m, 300.0, 0.5);
  EXPECT_TRUE(made.places[0].reached_s.has_value());
}

TEST_F(MissionReportTest, StatesAHeightSoThatItCanBeCountedFromElsewhere) {
  Json above_ground = item(16, 1500, 1400, 300);
  above_ground["frame"] = 10;
  const MissionReport made = report(scenario(Json::array({above_ground})));
  ASSERT_EQ(made.places.size(), 1U);
  EXPECT_NEAR(made.places[0].height_agl_m, 300.0, 1e-6);
  const double above_home_m = made.places[0].height_above_home_m;
  const MissionReport again = report(scenario(Json::array({item(16, 1500, 1400, above_home_m)})));
  ASSERT_EQ(again.places.size(), 1U);
  EXPECT_NEAR(again.places[0].height_agl_m, 300.0, 1e-3);
  EXPECT_NEAR(again.places[0].height_above_home_m, above_home_m, 1e-4);  // items hold floats
}

TEST_F(MissionReportTest, WarnsOfWhatIsBeyondItsLimits) {
  Json circle = item(18, 0, 600, 120, 1);
  circle["params"][2] = 40.0;
  const Json items = {item(16, 0, -1200, 120), circle, item(16, 0, 2600, 30)};
  MissionRequest request;
  request.limits.max_motion_px = 5.0;
  request.limits.min_overlap = 0.95;
  request.limits.min_start_s = 3600.0;
  const MissionReport made = report(scenario(items), request);
  const std::vector<std::string> found = kinds(made);
  for (const char* kind :
       {"bank", "clearance", "texture", "overlap", "motion", "imagery", "start"}) {
    EXPECT_THAT(found, ::testing::Contains(kind));
  }
  const auto text_of = [&](const char* kind) {
    for (const MissionWarning& warning : made.warnings) {
      if (warning.kind == kind) return warning.text;
    }
    return std::string();
  };
  // tan^-1(25^2 / (9.8 x 40)) = 57.9 deg.
  EXPECT_THAT(text_of("bank"),
              HasSubstr("item 2 with a radius of 40 m needs a bank of 58 deg: "
                        "must be at most 45 deg"));
  EXPECT_THAT(text_of("clearance"), HasSubstr("height above the ground"));
  EXPECT_THAT(text_of("clearance"), HasSubstr("must be at least 50 m"));
  EXPECT_THAT(text_of("start"), HasSubstr("must be at least 3600 s"));
}

TEST_F(MissionReportTest, HasNoWarningsWhenAllIsWell) {
  MissionRequest request;
  request.limits.min_texels_px = 0.05;  // texels of 4 m
  const MissionReport made =
      report(scenario({item(16, 0, 0, 300), item(16, 0, 1000, 330)}), request);
  for (const MissionWarning& warning : made.warnings) ADD_FAILURE() << warning.text;
}

TEST_F(MissionReportTest, SaysWhatIsNotFlown) {
  Json camera = item(203, 0, 0, 0);
  camera["frame"] = 2;
  const MissionReport made = report(scenario({item(16, 0, 0, 300), camera}));
  EXPECT_THAT(made.warnings.back().text, HasSubstr("item 2: command 203 was left out"));
  EXPECT_EQ(made.warnings.back().kind, "plan");
}

TEST_F(MissionReportTest, EndsOnTheGround) {
  const MissionReport made = report(scenario({item(16, 0, 0, 60), item(16, 0, 1000, -30)}));
  EXPECT_EQ(made.end, autopilot::FlightEnd::kHitGround);
  EXPECT_THAT(made.warnings.front().text, HasSubstr("the aircraft hits the ground after"));
}

TEST_F(MissionReportTest, RefusesWhatItCannotReport) {
  const Scenario flown = scenario(Json::array({item(16, 0, 0, 300)}));
  MissionRequest request;
  request.camera = "none";
  EXPECT_THAT(report_mission(flown, world_.world(), request).error().message,
              HasSubstr("camera = none: must be a camera of the scenario"));
  Scenario course = flown;
  course.flight = flight::CourseParameters{};
  EXPECT_THAT(report_mission(course, world_.world(), {}).error().message,
              HasSubstr("must be a mission"));
  EXPECT_THAT(report_mission(scenario(Json::array({item(82, 0, 0, 300)})), world_.world(), {})
                  .error()
                  .message,
              HasSubstr("item 1: command 82"));
  const std::atomic<bool> cancel{true};
  EXPECT_EQ(report_mission(flown, world_.world(), {}, &cancel).error().code, ErrorCode::kCancelled);
}

TEST_F(MissionReportTest, IsWrittenColumnByColumn) {
  MissionRequest request;
  request.samples = kMinMissionSamples;
  const MissionReport made = report(scenario(Json::array({item(16, 0, 0, 300)})), request);
  const Json json = json_from(made);
  for (const auto& [name, column] : json.at("samples").items()) {
    EXPECT_EQ(column.size(), made.samples.size()) << name;
  }
  EXPECT_EQ(json.at("end"), "done");
  EXPECT_EQ(json.at("camera"), "camera0");
  EXPECT_EQ(json.at("start").at("enough"), true);
}

}  // namespace
}  // namespace overfly::server
