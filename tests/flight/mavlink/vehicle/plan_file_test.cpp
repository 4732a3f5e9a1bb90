// Plans of QGroundControl: items, complex items, what is left out, errors.
#include "flight/mavlink/vehicle/plan_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/support.hpp"

namespace overfly::flight::mavlink {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string plan_of(const std::string& items, const std::string& more = "") {
  return R"({"fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
            "mission": {"version": 2, "plannedHomePosition": [39.355375, -86.030728, 227.7],
                        "items": [)" +
         items + "]}" + more + "}";
}

std::string simple(int command, int frame, const std::string& parameters) {
  return R"({"type": "SimpleItem", "autoContinue": true, "doJumpId": 1, "command": )" +
         std::to_string(command) + R"(, "frame": )" + std::to_string(frame) + R"(, "params": [)" +
         parameters + "]}";
}

std::string message_of(const std::string& text) {
  const Result<StoredMission> plan = parse_plan(text, "a.plan");
  return plan ? std::string("accepted") : plan.error().message;
}

TEST(PlanFile, GivesTheItemsOfTheSameMissionInLines) {
  const overfly::testing::TemporaryFolder folder;
  const auto plan_file = folder.path() / "a.plan";
  const auto text_file = folder.path() / "a.waypoints";
  overfly::testing::write_text(
      plan_file,
      " \n" + plan_of(simple(22, 3, "15, 0, 0, 0, 39.352675, -86.030728, 60") + "," +
                      simple(178, 2, "0, 22, -1, 0, 0, 0, 0") + "," +
                      simple(18, 10, "2, 0, 90, 0, 39.352675, -86.024928, 150.5")));
  overfly::testing::write_text(text_file,
                               "QGC WPL 110\n"
                               "0 1 0 16 0 0 0 0 39.355375 -86.030728 227.7 1\n"
                               "1 0 3 22 15 0 0 0 39.352675 -86.030728 60 1\n"
                               "2 0 2 178 0 22 -1 0 0 0 0 1\n"
                               "3 0 10 18 2 0 90 0 39.352675 -86.024928 150.5 1\n");
  const Result<StoredMission> plan = read_mission_file(plan_file);
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  const Result<StoredMission> text = read_mission_file(text_file);
  ASSERT_TRUE(text.ok()) << text.error().message;
  EXPECT_EQ(plan->items, text->items);
  EXPECT_THAT(plan->warnings, SizeIs(0));
}

TEST(PlanFile, ReadsAbsentParametersAsTheVehiclesDefaults) {
  const auto plan =
      parse_plan(plan_of(simple(16, 3, "null, 0, 0, null, 39.35, -86.03, 100")), "a.plan");
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  EXPECT_TRUE(std::isnan(plan->items[1].parameters[0]));
  EXPECT_EQ(plan->items[1].parameters[1], 0.0F);
  EXPECT_TRUE(std::isnan(plan->items[1].parameters[3]));
}

TEST(PlanFile, TakesTheStoredItemsOfSurveys) {
  const std::string survey =
      R"({"type": "ComplexItem", "complexItemType": "survey", "version": 5,
          "TransectStyleComplexItem": {"Items": [)" +
      simple(16, 3, "0, 0, 0, null, 39.35, -86.03, 100") + "," +
      simple(206, 2, "25, 0, 1, 0, 0, 0, 0") + R"(], "version": 1}})";
  const auto plan = parse_plan(plan_of(survey), "a.plan");
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  ASSERT_THAT(plan->items, SizeIs(3));
  EXPECT_EQ(plan->items[1].command, 16);
  EXPECT_EQ(plan->items[2].command, 206);
}

TEST(PlanFile, FliesLandingPatternsAsDescentAndLanding) {
  const std::string landing = R"({"type": "ComplexItem", "complexItemType": "fwLandingPattern",
      "altitudesAreRelative": true, "landCoordinate": [39.3501, -86.0302, 1],
      "landingApproachCoordinate": [39.3551, -86.0302, 40], "loiterClockwise": false,
      "loiterRadius": 75, "useLoiterToAlt": true, "version": 2})";
  const auto plan = parse_plan(plan_of(landing), "a.plan");
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  ASSERT_THAT(plan->items, SizeIs(4));
  EXPECT_EQ(plan->items[1].command, 189);  // DO_LAND_START
  EXPECT_EQ(plan->items[2].command, 31);   // NAV_LOITER_TO_ALT
  EXPECT_EQ(plan->items[2].parameters[1], -75.0F);
  EXPECT_EQ(plan->items[2].z, 40.0F);
  EXPECT_EQ(plan->items[3].command, 21);
  EXPECT_EQ(plan->items[3].x, 39.3501);
  EXPECT_EQ(plan->items[3].frame, 3);
}

TEST(PlanFile, SaysWhatIsNotFlown) {
  const auto plan =
      parse_plan(plan_of(simple(16, 3, "0, 0, 0, 0, 39.35, -86.03, 100"),
                         R"(, "geoFence": {"circles": [{}], "polygons": [{}, {}], "version": 2},
                  "rallyPoints": {"points": [[39.35, -86.03, 50]], "version": 2})"),
                 "a.plan");
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  ASSERT_THAT(plan->warnings, SizeIs(2));
  EXPECT_EQ(plan->warnings[0], "a.plan: the geofence is not used, 3 areas");
  EXPECT_EQ(plan->warnings[1], "a.plan: rally points are not used, 1");
}

TEST(PlanFile, NamesFieldValueAndLimit) {
  EXPECT_THAT(message_of("{"), HasSubstr("a.plan, line 1, column 2"));
  EXPECT_THAT(message_of("[]"), HasSubstr("must be a JSON object"));
  EXPECT_THAT(message_of(R"({"mission": 1})"), HasSubstr("fileType: must be given: \"Plan\""));
  EXPECT_THAT(message_of(R"({"fileType": "Plan"})"), HasSubstr("mission: must be given"));
  EXPECT_THAT(message_of(R"({"fileType": "Plan", "mission": {"version": 1, "items": []}})"),
              HasSubstr("mission.version = 1: must be 2"));
  EXPECT_THAT(message_of(R"({"fileType": "Plan", "mission": {"version": 2, "items": []}})"),
              HasSubstr("mission.plannedHomePosition: must be given"));
  EXPECT_THAT(message_of(plan_of("7")), HasSubstr("mission.items.0.type: must be given"));
  EXPECT_THAT(message_of(plan_of(simple(70000, 3, "0,0,0,0,0,0,0"))),
              HasSubstr("mission.items.0.command = 70000: must be a whole number in [0, 65535]"));
  EXPECT_THAT(message_of(plan_of(simple(16, 99, "0,0,0,0,0,0,0"))),
              HasSubstr("mission.items.0.frame = 99: must be a whole number in [0, 21]"));
  EXPECT_THAT(message_of(plan_of(simple(16, 3, "0,0,0,0,91,0,0"))),
              HasSubstr("mission.items.0.params.4 = 91: must be a number in [-90, 90]"));
  EXPECT_THAT(message_of(plan_of(simple(16, 3, "0,0"))),
              HasSubstr("mission.items.0.params = [0,0]: must be an array of 7 numbers or null"));
  EXPECT_THAT(message_of(plan_of(simple(16, 3, "\"x\",0,0,0,0,0,0"))),
              HasSubstr("mission.items.0.params.0 = \"x\""));
  EXPECT_THAT(message_of(plan_of(R"({"type": "ComplexItem", "complexItemType": "StructureScan"})")),
              HasSubstr("mission.items.0.complexItemType = \"StructureScan\": must be a survey"));
  EXPECT_THAT(message_of(plan_of(R"({"type": "ComplexItem", "complexItemType":
                                     "fwLandingPattern", "loiterRadius": 1})")),
              HasSubstr("mission.items.0.loiterCoordinate: must be given"));
}

TEST(PlanFile, IsWrittenAndReadAgain) {
  const StoredMission read =
      parse_plan(plan_of(simple(22, 3, "15, 0, 0, null, 39.352675, -86.030728, 60.1") + "," +
                         simple(178, 2, "0, 22.3, -1, 0, 0, 0, 0")),
                 "a.plan")
          .value();
  const std::string text = plan_text(read.items);
  EXPECT_THAT(text, HasSubstr("60.1"));  // not 60.099998474
  const auto again = parse_plan(text, "b.plan");
  ASSERT_TRUE(again.ok()) << again.error().message;
  ASSERT_EQ(again->items.size(), read.items.size());
  for (std::size_t i = 0; i < read.items.size(); ++i) {
    EXPECT_EQ(again->items[i].command, read.items[i].command);
    EXPECT_EQ(again->items[i].frame, read.items[i].frame);
    EXPECT_EQ(again->items[i].x, read.items[i].x);
    EXPECT_EQ(again->items[i].z, read.items[i].z);
  }
  EXPECT_TRUE(std::isnan(again->items[1].parameters[3]));
  EXPECT_EQ(again->items[2].parameters, read.items[2].parameters);
}

TEST(PlanFile, HasAtMostAsManyItemsAsOtherMissions) {
  std::string items = simple(16, 3, "0,0,0,0,39.35,-86.03,100");
  const std::string one = items;
  for (std::size_t i = 1; i < kMaxMissionItems; ++i) items += "," + one;
  EXPECT_THAT(message_of(plan_of(items)), HasSubstr("more than 5000 mission items"));
}

}  // namespace
}  // namespace overfly::flight::mavlink
