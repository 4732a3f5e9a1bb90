// Scenarios read, overridden and resolved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "server/scenario/document/scenario_schema.hpp"
#include "server/scenario/scenario.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;
using Json = nlohmann::json;

Json course_document() {
  return {{"format_version", 1},
          {"world", {{"builtin", Json::object()}}},
          {"flight", {{"course", Json::object()}}}};
}

std::vector<Override> overrides(const std::vector<std::string>& texts) {
  std::vector<Override> changes;
  for (const std::string& text : texts) changes.push_back(parse_override(text).value());
  return changes;
}

std::string error_of(const Json& document, const std::vector<std::string>& texts) {
  const Result<Scenario> scenario = resolve_scenario(document, overrides(texts), "/tmp");
  return scenario ? "" : scenario.error().message;
}

TEST(Scenario, FillsInTheDefaultsOfThePaper) {
  const Result<Scenario> scenario = resolve_scenario(course_document(), {}, "/tmp");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  EXPECT_EQ(scenario->cameras.front().model.pinhole().width_px, 1280);
  EXPECT_EQ(scenario->cameras.front().model.pinhole().height_px, 960);
  EXPECT_NEAR(scenario->cameras.front().model.pinhole().fx_px, 700.006, 0.001);
  EXPECT_EQ(scenario->cameras.front().model.pinhole().cx_px, 639.5);
  EXPECT_EQ(scenario->rate.numerator, 31);
  EXPECT_EQ(scenario->pacing, Pacing::kLockstep);
  EXPECT_TRUE(scenario->estimators.empty());
  const auto& course = std::get<flight::CourseParameters>(scenario->flight);
  EXPECT_NEAR(course.roll_rate_max_rad_s, rad_from_deg(45.0), 1e-12);
  EXPECT_EQ(course.length_m, 3300.0);
  EXPECT_EQ(scenario->resolved.at("flight").at("course").at("airspeed_m_s"), 25);
}

TEST(Scenario, SaysFieldValueAndLimitOfEveryError) {
  const std::string errors =
      error_of(course_document(), {"camera.fov_deg=190", "flight.course.airspeed_m_s=4", "sed=1"});
  EXPECT_THAT(errors, HasSubstr("camera.fov_deg = 190: must be in (0, 180)"));
  EXPECT_THAT(errors, HasSubstr("flight.course.airspeed_m_s = 4: must be in [5, 80]"));
  EXPECT_THAT(errors, HasSubstr("sed = 1: no such field (known: $schema, camera,"));
}

TEST(Scenario, LetsAnAirframeFlyTheCourse) {
  const Result<Scenario> scenario =
      resolve_scenario(course_document(),
                       overrides({"flight.course.dynamics=piper_cub_third",
                                  "flight.course.wind={\"from_deg\": 180, \"speed_m_s\": 4}",
                                  "flight.course.turbulence=moderate",
                                  "flight.course.terrain_following=false",
                                  "flight.course.autopilot={\"RLL2SRV_TCONST\": 0.5}"}),
                       "/tmp");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  ASSERT_TRUE(scenario->course_dynamics.has_value());
  EXPECT_EQ(scenario->course_dynamics->airframe.name, "piper_cub_third");
  EXPECT_NEAR(scenario->course_dynamics->airframe.wind_from_rad, kPi, 1e-12);
  EXPECT_EQ(scenario->course_dynamics->airframe.wind_m_s, 4.0);
  EXPECT_EQ(scenario->course_dynamics->airframe.turbulence, dynamics::TurbulenceLevel::kModerate);
  EXPECT_FALSE(scenario->course_dynamics->terrain_following);
  EXPECT_EQ(scenario->course_dynamics->airframe.autopilot.at("RLL2SRV_TCONST"), 0.5);
  const Result<Scenario> file = resolve_scenario(
      course_document(), overrides({"flight.course.dynamics=./mine.json"}), "/tmp/scenarios");
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->course_dynamics->airframe.file, "/tmp/scenarios/mine.json");
  EXPECT_THAT(check_scenario(*file).error().message, HasSubstr("flight.course.dynamics"));
  EXPECT_FALSE(resolve_scenario(course_document(), {}, "/tmp")->course_dynamics.has_value());
}

TEST(Scenario, FliesAMissionFile) {
  const Result<Scenario> scenario =
      resolve_scenario(course_document(),
                       overrides({"flight.mission.file=./plan.waypoints",
                                  "flight.mission.airframe=foam_trainer",
                                  "flight.mission.airspeed_m_s=11",
                                  "flight.mission.home={\"east_m\": 5, \"north_m\": -6}"}),
                       "/tmp/scenarios");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  const auto& mission = std::get<ScenarioMission>(scenario->flight);
  EXPECT_EQ(mission.file, "/tmp/scenarios/plan.waypoints");
  EXPECT_EQ(mission.airframe.name, "foam_trainer");
  EXPECT_EQ(mission.airspeed_m_s, 11.0);
  EXPECT_EQ(mission.home_m, Eigen::Vector2d(5.0, -6.0));
  EXPECT_THAT(check_scenario(*scenario).error().message, HasSubstr("flight.mission.file"));
  EXPECT_THAT(error_of(course_document(),
                       {"flight.mission.file=./plan.waypoints", "flight.mission.airframe=x"}),
              HasSubstr("flight.mission.airframe = \"x\": must be one of aerosonde, "));
}

TEST(Scenario, FliesAMissionWithinTheScenario) {
  const std::string plan = R"({"fileType": "Plan", "version": 1, "mission": {"version": 2,
      "plannedHomePosition": [39.355375, -86.030728, 227.7], "items": [{"type": "SimpleItem",
      "command": 16, "frame": 3, "params": [0, 0, 0, null, 39.36, -86.03, 150]}]}})";
  const Result<Scenario> scenario =
      resolve_scenario(course_document(), overrides({"flight.mission.plan=" + plan}), "/tmp");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  const auto& mission = std::get<ScenarioMission>(scenario->flight);
  EXPECT_TRUE(mission.file.empty());
  EXPECT_EQ(nlohmann::json::parse(mission.plan), nlohmann::json::parse(plan));
  EXPECT_EQ(mission.airspeed_m_s, 25.0);
  EXPECT_TRUE(check_scenario(*scenario).ok());
  // A run's copy of the scenario contains the mission.
  EXPECT_EQ(scenario->resolved.at("flight").at("mission").at("plan"), nlohmann::json::parse(plan));
}

TEST(Scenario, NamesTheFieldOfAPlanThatIsWrong) {
  const std::string head = "flight.mission.plan={\"fileType\": \"Plan\", \"mission\": ";
  EXPECT_THAT(error_of(course_document(), {head + "{\"version\": 1}}"}),
              HasSubstr("flight.mission.plan.mission.version = 1: must be 2"));
  EXPECT_THAT(error_of(course_document(), {"flight.mission.plan={}"}),
              HasSubstr("flight.mission.plan.mission: must be given"));
  EXPECT_THAT(error_of(course_document(), {"flight.mission.airspeed_m_s=20"}),
              HasSubstr("must be exactly one of a mission with a file, a mission with a plan"));
  EXPECT_THAT(
      error_of(course_document(), {"flight.mission.file=a.plan", head + "{\"version\": 2}}"}),
      HasSubstr("must be exactly one of a mission with a file, a mission with a plan"));
}

TEST(Scenario, RejectsWindAndTurbulenceWithoutAnAirframe) {
  EXPECT_THAT(error_of(course_document(), {"flight.course.dynamics=spitfire"}),
              HasSubstr("flight.course.dynamics = \"spitfire\": must be one of coordinated, "
                        "aerosonde, foam_trainer, piper_cub_third, or an airframe file (.json)"));
  for (const char* field : {"flight.course.wind={\"speed_m_s\": 4}",
                            "flight.course.turbulence=light",
                            "flight.course.terrain_following=false",
                            "flight.course.autopilot={\"RLL2SRV_TCONST\": 0.5}"}) {
    EXPECT_THAT(error_of(course_document(), {field}), HasSubstr("needs an airframe")) << field;
  }
}

TEST(Scenario, NamesTheVerticalDatumAsAManifestDoes) {
  Json document = course_document();
  document["world"] = {{"imagery", {{{"file", "a.tif"}}}},
                       {"elevation", {{{"file", "b.tif"}, {"vertical_datum", "egm2008"}}}}};
  const Result<Scenario> scenario = resolve_scenario(document, {}, "/tmp");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  EXPECT_EQ(std::get<terrain::WorldSpec>(scenario->world).elevation.front().datum,
            terrain::VerticalDatum::kEgm2008);
  // The name of before.
  document["world"]["elevation"][0] = {{"file", "b.tif"}, {"datum", "egm2008"}};
  EXPECT_THAT(error_of(document, {}),
              HasSubstr("world.elevation.0.datum = \"egm2008\": no such field; did you mean "
                        "vertical_datum? (known: "));
}

TEST(Scenario, SaysWhatTheSchemaCannotSay) {
  EXPECT_THAT(error_of(course_document(), {"flight.course.leg_length_m=3300"}),
              HasSubstr("flight.course.leg_length_m = 3300: must be less than"));
  EXPECT_THAT(
      error_of(course_document(),
               {R"(estimators=[{"name":"a","type":"perfect"},{"name":"a","type":"perfect"}])"}),
      HasSubstr("estimators.1.name = \"a\": must be unique"));
  EXPECT_THAT(
      error_of(course_document(), {"camera.fx_px=700", "camera.fy_px=700", "camera.fov_deg=80"}),
      HasSubstr("camera.fx_px = 700: must not be given with camera.fov_deg"));
  EXPECT_THAT(error_of(course_document(), {"camera.fx_px=700"}),
              HasSubstr("camera.fy_px: must be given with camera.fx_px"));
}

TEST(Scenario, TakesFocalLengthsAndCentresThePrincipalPoint) {
  const auto scenario =
      resolve_scenario(course_document(),
                       overrides({"camera.fx_px=500", "camera.fy_px=501", "camera.width_px=640"}),
                       "/tmp");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  EXPECT_EQ(scenario->cameras.front().model.pinhole().fy_px, 501.0);
  EXPECT_EQ(scenario->cameras.front().model.pinhole().cx_px, 319.5);
}

TEST(ScenarioOverride, IsJsonElseText) {
  EXPECT_EQ(parse_override("a.b=3")->value, 3);
  EXPECT_EQ(parse_override("a=real_time")->value, "real_time");
  EXPECT_EQ(parse_override("a=x=y")->value, "x=y");
  EXPECT_EQ(parse_override("a=[1]")->value, Json::array({1}));
  EXPECT_FALSE(parse_override("a").ok());
  // A mistake in an object or array is reported, not taken as text.
  EXPECT_NE(parse_override("a.b={\"c\":1,\"c\":2}").error().message.find("a.b"), std::string::npos);
  EXPECT_EQ(parse_override("a=[1,").error().code, ErrorCode::kInvalidArgument);
  EXPECT_FALSE(parse_override("=1").ok());
  const auto deep = parse_override("a=" + std::string(100'000, '['));
  ASSERT_FALSE(deep.ok());
  EXPECT_EQ(deep.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(deep.error().message, "a: is nested more than 64 deep");
}

/// A path of `parts` parts.
std::string path_of(std::size_t parts) {
  std::string path = "seed";
  for (std::size_t i = 1; i < parts; ++i) path += ".a";
  return path;
}

/// 1 inside of `depth` arrays.
Json nested(std::size_t depth) {
  Json value = 1;
  for (std::size_t i = 0; i < depth; ++i) value = Json::array({std::move(value)});
  return value;
}

TEST(ScenarioOverride, LimitsThePathsPartsAndTheDepthThatTheyMake) {
  const auto error = [](const std::string& path, const Json& value) {
    Json document = course_document();
    document.erase("seed");
    const auto scenario = resolve_scenario(document, {{path, value}}, "/tmp");
    EXPECT_FALSE(scenario.ok());
    EXPECT_EQ(scenario.error().code, ErrorCode::kInvalidArgument);
    return scenario.error().message;
  };
  EXPECT_THAT(error(path_of(64), 1), HasSubstr("seed = "));  // the schema's error
  const std::string long_path = error(path_of(100'000), 1);
  EXPECT_THAT(long_path, HasSubstr("has 100000 parts: must have at most 64"));
  EXPECT_LT(long_path.size(), 200U);
  EXPECT_THAT(error("seed", nested(63)), HasSubstr("seed = "));
  EXPECT_THAT(error("seed", nested(64)), HasSubstr("nested more than 64 deep"));
  EXPECT_THAT(error(path_of(40), nested(40)), HasSubstr("nested more than 64 deep"));
}

TEST(ScenarioOverride, ReachesArraysAndReplacesTheKindOfWorld) {
  Json document = course_document();
  const auto scenario = resolve_scenario(document,
                                         overrides({"estimators.0.name=e",
                                                    "estimators.0.type=drifting",
                                                    "estimators.0.parameters.drift=0.01",
                                                    "world.manifest=w.json"}),
                                         "/base");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  EXPECT_EQ(text_of(scenario->estimators.at(0).parameters.at("drift")), "0.01");
  EXPECT_EQ(std::get<std::filesystem::path>(scenario->world), "/base/w.json");
  EXPECT_THAT(error_of(document, {"estimators.2.name=e"}), HasSubstr("must be a number in [0, 0]"));
  EXPECT_THAT(error_of(document, {"seed.x=1", "seed.y.z=2"}), HasSubstr("seed"));
  EXPECT_THAT(error_of(document, {"format_version.x=1"}), HasSubstr("not an object or array"));
}

/// Also those that are added to the schema later.
TEST(ScenarioOverride, ReplacesEveryKindOfFlightAndWorld) {
  const Json schema = Json::parse(scenario_schema_text());
  for (const char* field : {"flight", "world"}) {
    for (const Json& branch : schema.at("properties").at(field).at("oneOf")) {
      const std::string place = branch.at("$ref");
      const Json& kind = schema.at("$defs").at(place.substr(place.rfind('/') + 1));
      const std::string name = kind.at("required").at(0);
      Json document = {{field, {{"another", 1}}}};
      ASSERT_TRUE(apply_override({std::string(field) + "." + name, Json::object()}, document).ok());
      EXPECT_EQ(document, (Json{{field, {{name, Json::object()}}}})) << name;
    }
  }
}

TEST(ScenarioOverride, WholeCamerasTakeTheCamerasPlaceAndBack) {
  Json document = course_document();
  document["camera"] = {{"width_px", 320}};
  const char* two = R"(cameras=[{"name":"a"},{"name":"b"}])";
  const auto several = resolve_scenario(document, overrides({two}), "/");
  ASSERT_TRUE(several.ok()) << several.error().message;
  EXPECT_EQ(several->cameras.size(), 2U);
  const auto one = resolve_scenario(document, overrides({two, R"(camera={"name":"c"})"}), "/");
  ASSERT_TRUE(one.ok()) << one.error().message;
  ASSERT_EQ(one->cameras.size(), 1U);
  EXPECT_EQ(one->cameras[0].name, "c");
  EXPECT_THAT(error_of(document, {two, "camera.width_px=64"}),
              HasSubstr("must not be given with cameras"));
}

TEST(Scenario, RefusesAFileOfDeepJson) {
  const TemporaryFolder folder;
  overfly::testing::write_text(folder.path() / "a.json",
                               R"({"title": )" + std::string(100'000, '['));
  EXPECT_THAT(load_scenario(folder.path() / "a.json").error().message,
              HasSubstr("a.json: is nested more than 64 deep"));
}

TEST(Scenario, FindsFilesInDataOrBesideItselfAndItsCopyMeansTheSame) {
  const TemporaryFolder folder;
  const char* text = R"({"format_version": 1, "data": "d",
    "world": {"imagery": [{"file": "a.tif"}], "ground_height_m": 0},
    "flight": {"log": {"file": "./tour.csv"}}})";
  overfly::testing::write_text(folder.path() / "first one.json", text);
  const auto scenario = load_scenario(folder.path() / "first one.json");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  EXPECT_EQ(scenario->name, "first_one");
  const auto& world = std::get<terrain::WorldSpec>(scenario->world);
  const bool replaced = std::getenv("OVERFLY_DATA") != nullptr;
  if (!replaced) {
    EXPECT_EQ(world.imagery.at(0).file, folder.path() / "d" / "a.tif");
  }
  EXPECT_EQ(std::get<LoggedFlight>(scenario->flight).file, folder.path() / "tour.csv");

  const TemporaryFolder elsewhere;
  overfly::testing::write_text(elsewhere.path() / "scenario.json", scenario->resolved.dump());
  const auto copy = load_scenario(elsewhere.path() / "scenario.json");
  ASSERT_TRUE(copy.ok()) << copy.error().message;
  EXPECT_EQ(copy->name, "first_one");
  EXPECT_EQ(std::get<terrain::WorldSpec>(copy->world).imagery.at(0).file, world.imagery.at(0).file);
  EXPECT_EQ(std::get<LoggedFlight>(copy->flight).file, folder.path() / "tour.csv");
  EXPECT_EQ(copy->resolved, scenario->resolved);
}

TEST(Scenario, NamesLineAndColumnOfBrokenJson) {
  const TemporaryFolder folder;
  overfly::testing::write_text(folder.path() / "a.json", "{\n  \"seed\": 1,\n  oops\n}");
  const auto scenario = load_scenario(folder.path() / "a.json");
  ASSERT_FALSE(scenario.ok());
  EXPECT_EQ(scenario.error().code, ErrorCode::kUnreadable);
  EXPECT_THAT(scenario.error().message, HasSubstr("line 3"));
  EXPECT_EQ(load_scenario(folder.path() / "b.json").error().code, ErrorCode::kNotFound);
}

TEST(ScenarioList, SaysWhichFilesAreMissing) {
  const TemporaryFolder folder;
  overfly::testing::write_text(folder.path() / "a.json", R"({"format_version": 1,
    "world": {"manifest": "no.json"}, "flight": {"log": {"file": "no.csv"}}})");
  overfly::testing::write_text(folder.path() / "a.schema.json", "{}");
  const auto entries = list_scenarios(folder.path());
  ASSERT_EQ(entries.size(), 1U);
  EXPECT_THAT(entries[0].error, HasSubstr("world.manifest"));
  EXPECT_THAT(entries[0].error, HasSubstr("flight.log.file"));
  EXPECT_FALSE(scenario_path(folder.path(), "../a").ok());
  EXPECT_FALSE(scenario_path(folder.path(), "a.schema").ok());
  EXPECT_TRUE(scenario_path(folder.path(), "a").ok());
}

TEST(ScenarioList, ShippedScenariosAreValid) {
  for (const ScenarioEntry& entry : list_scenarios(overfly::testing::source_file("scenarios"))) {
    EXPECT_TRUE(load_scenario(entry.file).ok()) << entry.error;
  }
}

}  // namespace
}  // namespace overfly::server
