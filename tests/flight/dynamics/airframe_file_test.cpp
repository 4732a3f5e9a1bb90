// Airframe files: what they hold, and the messages about faulty ones.
#include "flight/dynamics/airframe_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/motion/pose.hpp"
#include "tests/flight/dynamics/airframes.hpp"
#include "tests/support/support.hpp"

namespace overfly::dynamics {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::string aerosonde_text() {
  return overfly::testing::read_text(
      overfly::testing::source_file("scenarios/airframes/aerosonde.json"));
}

/// The message about the Aerosonde with one value replaced, empty if it is accepted.
std::string complaint(const std::string& pointer, const Json& value) {
  Json document = Json::parse(aerosonde_text());
  document[Json::json_pointer(pointer)] = value;
  const Result<Airframe> airframe = parse_airframe(document.dump(), "plane.json");
  return airframe.ok() ? "" : airframe.error().message;
}

TEST(AirframeFile, HoldsTheAerosondeOfTheBook) {
  const Airframe airframe = testing::airframe("aerosonde");
  EXPECT_EQ(airframe.mass_kg, 11.0);
  EXPECT_EQ(airframe.inertia.xz, 0.1204);
  EXPECT_EQ(airframe.lift.alpha, 5.61);
  EXPECT_EQ(airframe.pitch.pitch_rate, -38.21);
  EXPECT_EQ(airframe.side.beta, -0.98);
  EXPECT_EQ(airframe.roll.aileron, 0.17);
  EXPECT_EQ(airframe.yaw.rudder, -0.069);
  EXPECT_EQ(airframe.propulsion.torque.quadratic, -0.01664);
  EXPECT_NEAR(airframe.stall.alpha_rad, rad_from_deg(27.0), 1e-15);
  EXPECT_NEAR(airframe.elevator.min_rad, rad_from_deg(-30.0), 1e-15);
  EXPECT_NEAR(airframe.aspect_ratio(), 15.245, 1e-3);
}

TEST(AirframeFile, EveryFileOfTheFolderIsRead) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(overfly::testing::source_file("scenarios/airframes"))) {
    if (entry.path().extension() != ".json") continue;
    const auto airframe = read_airframe(entry.path());
    EXPECT_TRUE(airframe.ok()) << airframe.error().message;
    ++files;
  }
  EXPECT_EQ(files, 3);
}

TEST(AirframeFile, FaultsNameFileFieldValueAndLimit) {
  EXPECT_EQ(complaint("/mass_kg", 0.0),
            "plane.json: mass_kg = 0.0: must be a number in [0.05, 2000]");
  EXPECT_EQ(complaint("/mass_kg", "heavy"),
            "plane.json: mass_kg = \"heavy\": must be a number in [0.05, 2000]");
  EXPECT_EQ(complaint("/stall/alpha_deg", 95),
            "plane.json: stall.alpha_deg = 95: must be a number in [3, 60]");
  EXPECT_EQ(complaint("/pitch/elevator", 0.5),
            "plane.json: pitch.elevator = 0.5: must be a number in [-10, -0.001]");
  EXPECT_EQ(complaint("/wing", 3), "plane.json: wing.area_m2 is missing");
  EXPECT_EQ(complaint("/name", ""), "plane.json: name = \"\": must be a text of 1 to 2000 bytes");
  EXPECT_EQ(complaint("/wing/winglets", 2),
            "plane.json: \"wing.winglets\" is not a field of an airframe");
  EXPECT_THAT(complaint("/inertia_kg_m2/xz", 5.0), HasSubstr("inertia_kg_m2: no body has"));
  EXPECT_THAT(complaint("/inertia_kg_m2/yy", 9.0), HasSubstr("inertia_kg_m2: no body has"));
  EXPECT_EQ(complaint("/wing/area_m2", 40),
            "plane.json: mass_kg = 11: must be at least 20 (0.5 kg per m^2 of wing)");
  EXPECT_THAT(complaint("/wing/span_m", 8.0), HasSubstr("least moment about x and z = 0.8"));
  EXPECT_THAT(complaint("/wing/chord_m", 3.0), HasSubstr("inertia_kg_m2.yy = 1.135: must be at"));
  EXPECT_THAT(complaint("/propulsion/battery_v", 100), HasSubstr("tips move at 385."));
  EXPECT_THAT(complaint("/propulsion/torque/zero", 0.1), HasSubstr("more thrust than torque"));
  EXPECT_THAT(complaint("/propulsion/thrust/zero", 0.2), HasSubstr("drive without power"));
  EXPECT_THAT(complaint("/actuators/aileron/max_deg", 0),
              HasSubstr("actuators.aileron: must move to both sides"));
  EXPECT_EQ(complaint("/actuators/elevator/max_deg", 7), "") << "unlike min_deg";
  EXPECT_EQ(complaint("/mass_kg", 12.0), "");
}

TEST(AirframeFile, EveryNumberIsCheckedAndNeeded) {
  const Json whole = Json::parse(aerosonde_text());
  int numbers = 0;
  const Json flat = whole.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (!value.is_number()) continue;
    ++numbers;
    EXPECT_NE(complaint(pointer, 1e9), "") << pointer;
    EXPECT_NE(complaint(pointer, -1e9), "") << pointer;
    EXPECT_NE(complaint(pointer, nullptr), "") << pointer;
    EXPECT_NE(complaint(pointer, Json::array({1})), "") << pointer;
    Json without = whole;
    const Json::json_pointer at(pointer);
    without[at.parent_pointer()].erase(at.back());
    const auto airframe = parse_airframe(without.dump(), "plane.json");
    ASSERT_FALSE(airframe.ok()) << pointer;
    std::string field = pointer.substr(1);
    std::replace(field.begin(), field.end(), '/', '.');
    EXPECT_EQ(airframe.error().message, "plane.json: " + field + " is missing");
  }
  EXPECT_EQ(numbers, 61);
}

TEST(AirframeFile, HostileTextsAreErrors) {
  const std::string text = aerosonde_text();
  for (std::size_t end = 0; end < text.size(); end += 7) {
    EXPECT_FALSE(parse_airframe(text.substr(0, end), "cut").ok() && end < text.size() - 2);
  }
  for (const std::string& bad : std::vector<std::string>{"",
                                                         "[]",
                                                         "null",
                                                         "3",
                                                         "{}",
                                                         "{\"mass_kg\": 1e999}",
                                                         "{\"name\": \"\xff\"}",
                                                         std::string(100000, '['),
                                                         std::string(1000, '\0')}) {
    const auto airframe = parse_airframe(bad, "bad.json");
    ASSERT_FALSE(airframe.ok());
    EXPECT_THAT(airframe.error().message, HasSubstr("bad.json"));
    EXPECT_LT(airframe.error().message.size(), 500U);
  }
  EXPECT_LT(complaint("/name", std::string(1 << 16, 'x')).size(), 300U);
}

TEST(AirframeFile, MissingAndLargeFilesAreErrors) {
  const overfly::testing::TemporaryFolder folder;
  EXPECT_EQ(read_airframe(folder.path() / "none.json").error().code, ErrorCode::kNotFound);
  overfly::testing::write_text(folder.path() / "large.json", std::string(2 << 20, ' '));
  EXPECT_EQ(read_airframe(folder.path() / "large.json").error().code, ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace overfly::dynamics
