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
  const flight::SensorModels& m = scenario.sensors;
  const flight::ImuModel imu;
  EXPECT_EQ(m.imu->gyroscope_noise_rad_s_sqrt_hz, imu.gyroscope_noise_rad_s_sqrt_hz);
  EXPECT_EQ(m.imu->gyroscope_walk_rad_s2_sqrt_hz, imu.gyroscope_walk_rad_s2_sqrt_hz);
  EXPECT_EQ(m.imu->accelerometer_noise_m_s2_sqrt_hz, imu.accelerometer_noise_m_s2_sqrt_hz);
  EXPECT_EQ(m.imu->accelerometer_walk_m_s3_sqrt_hz, imu.accelerometer_walk_m_s3_sqrt_hz);
  const flight::BarometerModel barometer;
  EXPECT_EQ(m.barometer->rate_hz, barometer.rate_hz);
  EXPECT_EQ(m.barometer->noise_pa, barometer.noise_pa);
  EXPECT_EQ(m.barometer->drift_pa, barometer.drift_pa);
  EXPECT_EQ(m.barometer->temperature_noise_k, barometer.temperature_noise_k);
  EXPECT_EQ(m.barometer->temperature_drift_k, barometer.temperature_drift_k);
  EXPECT_EQ(m.barometer->drift_time_s, barometer.drift_time_s);
  const flight::GpsModel gps;
  EXPECT_EQ(m.gps->rate_hz, gps.rate_hz);
  EXPECT_EQ(m.gps->delay_s, gps.delay_s);
  EXPECT_EQ(m.gps->horizontal_drift_m, gps.horizontal_drift_m);
  EXPECT_EQ(m.gps->vertical_drift_m, gps.vertical_drift_m);
  EXPECT_EQ(m.gps->drift_time_s, gps.drift_time_s);
  EXPECT_EQ(m.gps->horizontal_noise_m, gps.horizontal_noise_m);
  EXPECT_EQ(m.gps->vertical_noise_m, gps.vertical_noise_m);
  EXPECT_EQ(m.gps->velocity_noise_m_s, gps.velocity_noise_m_s);
  const flight::AirspeedModel airspeed;
  EXPECT_EQ(m.airspeed->rate_hz, airspeed.rate_hz);
  EXPECT_EQ(m.airspeed->noise_pa, airspeed.noise_pa);
  EXPECT_EQ(m.airspeed->drift_pa, airspeed.drift_pa);
  EXPECT_EQ(m.airspeed->drift_time_s, airspeed.drift_time_s);
  const flight::MagnetometerModel magnetometer;
  EXPECT_EQ(m.magnetometer->rate_hz, magnetometer.rate_hz);
  EXPECT_EQ(m.magnetometer->noise_ut, magnetometer.noise_ut);
  EXPECT_EQ(m.magnetometer->bias_ut, magnetometer.bias_ut);
  const flight::RangeModel range;
  EXPECT_EQ(m.range->rate_hz, range.rate_hz);
  EXPECT_EQ(m.range->noise_m, range.noise_m);
  EXPECT_EQ(m.range->min_m, range.min_m);
  EXPECT_EQ(m.range->max_m, range.max_m);
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
