// Flight logs of scenarios: their fields, and which files they may name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/pose.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Json document_of(const char* log) {
  return {{"format_version", 1},
          {"world", {{"builtin", Json::object()}}},
          {"flight", {{"log", Json::parse(log)}}}};
}

std::string log_error(const char* log) {
  const auto scenario = resolve_scenario(document_of(log), {}, "/base");
  return scenario ? "" : scenario.error().message;
}

TEST(ScenarioFlight, ReadsAllFieldsOfALog) {
  const auto scenario = resolve_scenario(document_of(R"({
    "file": "a.bin", "source": "GPS", "from_s": 10, "to_s": 60, "time_offset_s": 0.25,
    "geoid_separation_m": -33,
    "smooth": {"jump_m": 3, "jump_deg": 5, "jerk_psd_m2_s5": 10, "angular_psd_rad2_s3": 0.1,
               "board": {"yaw_deg": 90}},
    "rebase": {"point": "start", "east_m": 100, "north_m": -50, "lowest_agl_m": 120,
               "turn_deg": -45}})"),
                                         {},
                                         "/base");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  const auto& flight = std::get<LoggedFlight>(scenario->flight);
  const flight::LogFlightOptions& log = flight.log;
  EXPECT_EQ(flight.file, "/base/a.bin");
  EXPECT_EQ(log.source, "GPS");
  EXPECT_EQ(log.from_s, 10.0);
  EXPECT_EQ(log.to_s, 60.0);
  EXPECT_EQ(log.geoid_separation_m, -33.0);
  ASSERT_TRUE(log.smooth.has_value());
  EXPECT_EQ(log.smooth->time_offset_s, 0.25);
  EXPECT_EQ(log.smooth->jump_m, 3.0);
  EXPECT_NEAR(log.smooth->jump_rad, rad_from_deg(5.0), 1e-12);
  EXPECT_EQ(log.smooth->jerk_psd, 10.0);
  EXPECT_EQ(log.smooth->angular_psd, 0.1);
  // The board's x axis points to the body's right: the body's right is the board's x.
  const Eigen::Vector3d right_in_board = log.smooth->R_logged_body * Eigen::Vector3d::UnitY();
  EXPECT_LT((right_in_board - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  ASSERT_TRUE(log.rebase.has_value());
  EXPECT_EQ(log.rebase->point, flight::Rebase::Point::kStart);
  EXPECT_EQ(std::get<flight::PlaceInWorld>(log.rebase->at).north_m, -50.0);
  EXPECT_EQ(log.rebase->lowest_agl_m, 120.0);
  EXPECT_NEAR(log.rebase->turn_rad, rad_from_deg(-45.0), 1e-12);
  EXPECT_FALSE(flight.rebase_to_imagery);
  EXPECT_THAT(
      flight.log_fields,
      ElementsAre(
          "from_s", "geoid_separation_m", "rebase", "smooth", "source", "time_offset_s", "to_s"));
}

TEST(ScenarioFlight, HasDefaults) {
  const auto scenario =
      resolve_scenario(document_of(R"({"file": "a", "smooth": {}, "time_offset_s": "auto",
                      "rebase": {"lowest_agl_m": 50}})"),
                       {},
                       "/base");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  const auto& flight = std::get<LoggedFlight>(scenario->flight);
  const flight::smoothing::SmoothingOptions defaults;
  EXPECT_FALSE(flight.log.smooth->time_offset_s.has_value());
  EXPECT_EQ(flight.log.smooth->jump_m, defaults.jump_m);
  EXPECT_NEAR(flight.log.smooth->jump_rad, defaults.jump_rad, 1e-12);
  EXPECT_EQ(flight.log.smooth->jerk_psd, defaults.jerk_psd);
  EXPECT_EQ(flight.log.smooth->angular_psd, defaults.angular_psd);
  EXPECT_TRUE(flight.log.smooth->validate().ok());
  EXPECT_TRUE(flight.rebase_to_imagery);
  EXPECT_EQ(flight.log.rebase->point, flight::Rebase::Point::kCentre);
  const auto plain = resolve_scenario(document_of(R"({"file": "a.csv"})"), {}, "/base");
  EXPECT_TRUE(std::get<LoggedFlight>(plain->flight).log_fields.empty());
}

TEST(ScenarioFlight, RejectsWhatTheSchemaCannotExpress) {
  EXPECT_THAT(log_error(R"({"file": "a", "from_s": 5, "to_s": 5})"),
              HasSubstr("flight.log.to_s = 5: must be later than flight.log.from_s"));
  EXPECT_THAT(log_error(R"({"file": "a", "time_offset_s": "auto"})"),
              HasSubstr("must be a number without flight.log.smooth"));
  EXPECT_THAT(log_error(R"({"file": "a", "rebase": {"lowest_agl_m": 9, "east_m": 0, "north_m": 0,
                            "lat_deg": 1, "lon_deg": 2}})"),
              HasSubstr("must not be given with east_m and north_m"));
  EXPECT_THAT(log_error(R"({"file": "a", "rebase": {"lowest_agl_m": 9, "east_m": 0}})"),
              HasSubstr("north_m"));
  EXPECT_THAT(log_error(R"({"file": "a", "rebase": {}})"), HasSubstr("lowest_agl_m"));
  EXPECT_THAT(log_error(R"({"file": "a", "time_offset_s": 3})"),
              HasSubstr("flight.log.time_offset_s = 3"));
}

TEST(ScenarioFlight, ChecksTheFilesThatAMappingNames) {
  const overfly::testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "data");
  overfly::testing::write_text(folder.path() / "data" / "log.json",
                               R"({"csv_mapping_version": 1, "pieces": [
    {"name": "A", "file": "../a.csv", "time": {"column": "t", "unit": "s"}, "columns": {}}]})");
  overfly::testing::write_text(folder.path() / "a.csv", "t\n1\n");
  auto scenario =
      resolve_scenario(document_of(R"({"file": "log.json"})"), {}, folder.path() / "data");
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  EXPECT_TRUE(check_scenario(*scenario).ok());
  Scenario late = *scenario;
  late.start_ns = 1;
  EXPECT_THAT(check_scenario(late).error().message,
              HasSubstr("log.json is a flight log: use flight.log.from_s"));
  scenario->sources = SourcePolicy::inside({folder.path() / "data"});
  const Status outside = check_scenario(*scenario);
  ASSERT_FALSE(outside.ok());
  EXPECT_THAT(outside.error().message, HasSubstr("flight.log.file (a file that it names)"));
  EXPECT_THAT(outside.error().message, HasSubstr("inside of the server's data folders"));
}

}  // namespace
}  // namespace overfly::server
