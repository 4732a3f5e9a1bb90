// Sensors of a scenario: what a document means, and what it may not say.
#include <gtest/gtest.h>

#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

Result<Scenario> scenario_with(const std::vector<std::string>& texts) {
  const Json document = {{"format_version", 1},
                         {"world", {{"builtin", Json::object()}}},
                         {"flight", {{"course", Json::object()}}}};
  std::vector<Override> changes;
  for (const std::string& text : texts) changes.push_back(parse_override(text).value());
  return resolve_scenario(document, changes, "/tmp");
}

std::string sensors_error(const std::vector<std::string>& texts) {
  const Result<Scenario> scenario = scenario_with(texts);
  return scenario ? "" : scenario.error().message;
}

TEST(ScenarioSensors, AreFittedOnlyIfGiven) {
  EXPECT_TRUE(scenario_with({})->sensors.none());
  EXPECT_FALSE(scenario_with({})->resolved.contains("sensors"));
  EXPECT_TRUE(scenario_with({"sensors={}"})->sensors.none());
  const Scenario scenario =
      scenario_with({R"(sensors={"imu":{"rate_hz":400},"range":{}})"}).value();
  ASSERT_TRUE(scenario.sensors.imu && scenario.sensors.range);
  EXPECT_EQ(scenario.sensors.imu->rate_hz, 400.0);
  EXPECT_FALSE(scenario.sensors.gps || scenario.sensors.barometer || scenario.sensors.airspeed ||
               scenario.sensors.magnetometer);
}

TEST(ScenarioSensors, HaveTheDefaultsOfTheModels) {
  const Scenario scenario =
      scenario_with({R"(sensors={"imu":{},"barometer":{},"gps":{},"airspeed":{},"magnetometer":{},)"
                     R"("range":{}})"})
          .value();
  int checked = 0;
  scenario.sensors.with_each(
      [&]<typename Model>(const char* name, const std::optional<Model>& model) {
        ASSERT_TRUE(model) << name;
        for (const auto& field : flight::fields_of<Model>()) {
          EXPECT_EQ((*model).*field.value, Model().*field.value) << name << "." << field.name;
          ++checked;
        }
      });
  EXPECT_EQ(checked, 30);
}

TEST(ScenarioSensors, ErrorsNameFieldValueAndLimit) {
  EXPECT_EQ(sensors_error({R"(sensors={"gps":{"delay_s":11}})"}),
            "sensors.gps.delay_s = 11: must be in [0, 10]");
  EXPECT_EQ(sensors_error({R"(sensors={"imu":{"rate_hz":0}})"}),
            "sensors.imu.rate_hz = 0: must be in [0.001, 10000]");
  EXPECT_EQ(sensors_error({R"(sensors={"range":{"min_m":50,"max_m":40}})"}),
            "sensors.range.min_m = 50: must be in [0, 39.96]");
  EXPECT_EQ(
      sensors_error({R"(sensors={"lidar":{}})"}),
      "sensors.lidar = {}: no such field (known: airspeed, barometer, gps, imu, magnetometer, "
      "range)");
}

TEST(ScenarioSensors, AnOutageNeedsAGps) {
  const std::string outage = R"(faults=[{"kind":"gps_outage","at_s":5,"duration_s":2}])";
  EXPECT_EQ(sensors_error({outage}), "faults.0.kind = \"gps_outage\": must go with sensors.gps");
  const Scenario scenario = scenario_with({R"(sensors={"gps":{}})", outage}).value();
  ASSERT_EQ(scenario.faults.size(), 1U);
  EXPECT_EQ(scenario.faults[0].kind, FaultKind::kGpsOutage);
  EXPECT_EQ(scenario.faults[0].end_ns, 7'000'000'000);
  EXPECT_EQ(sensors_error({R"(sensors={"gps":{}})",
                           R"(faults=[{"kind":"gps_outage","at_s":5,"camera":"camera0"}])"}),
            "faults.0.camera = \"camera0\": must not be given for gps_outage");
}

}  // namespace
}  // namespace overfly::server
