// The sensors of a run over REST.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json sensor_of(const json& answer, const std::string& name) {
  for (const json& sensor : answer.at("sensors")) {
    if (sensor.at("sensor") == name) return sensor;
  }
  return nullptr;
}

json curve_of(const json& sensor, const std::string& name) {
  for (const json& curve : sensor.at("curves")) {
    if (curve.at("name") == name) return curve;
  }
  return nullptr;
}

TEST(SensorRoutes, GiveCurvesOfARun) {
  TestServer server;
  const json overrides = {{"sensors", {{"imu", json::object()}, {"gps", {{"rate_hz", 10}}}}}};
  const Answer started = ask(server.port(),
                             "POST",
                             "/api/v1/runs",
                             json{{"scenario", "tiny"}, {"overrides", overrides}}.dump(),
                             kJson);
  ASSERT_EQ(started.status, 201) << started.body;
  const std::string id = started.json().at("id");
  server.wait_for_end(id);
  const std::string place = "/api/v1/runs/" + id + "/sensors";
  const json answer = ask(server.port(), "GET", place).json();
  ASSERT_EQ(answer.at("sensors").size(), 2U);
  const json imu = sensor_of(answer, "imu");
  EXPECT_GT(imu.at("samples"), 390);
  const json down = curve_of(imu, "fz_m_s2");
  EXPECT_EQ(down.at("t_s").size(), down.at("values").size());
  EXPECT_LT(down.at("values").at(0).get<double>(), -5.0);
  // A drift of 4.7 m at most a few times over.
  const json north = curve_of(sensor_of(answer, "gps"), "north_error_m");
  ASSERT_GT(north.at("values").size(), 10U);
  for (const json& value : north.at("values")) EXPECT_LT(std::abs(value.get<double>()), 30.0);

  const json part = ask(server.port(), "GET", place + "?from_s=0.5&to_s=1.5&points=100").json();
  const json times = curve_of(sensor_of(part, "imu"), "wx_rad_s").at("t_s");
  EXPECT_LE(times.size(), 100U);
  EXPECT_GE(times.front().get<double>(), 0.5);
  EXPECT_LE(times.back().get<double>(), 1.5);

  std::ofstream(server.folder() / "runs" / id / "sensors" / "gps.csv", std::ios::app) << "bad\n";
  const Answer damaged = ask(server.port(), "GET", place);
  EXPECT_EQ(damaged.status, 422);
  EXPECT_THAT(damaged.body, HasSubstr("gps.csv:"));
}

TEST(SensorRoutes, SayWhatIsWrongWithARequest) {
  TestServer server;
  const std::string place = "/api/v1/runs/" + server.fly("tiny") + "/sensors";
  EXPECT_EQ(ask(server.port(), "GET", place).json().at("sensors").size(), 0U);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/runs/none/sensors").status, 404);
  for (const char* query :
       {"?points=99", "?points=10001", "?from_s=-1", "?from_s=2&to_s=1", "?x=1"}) {
    EXPECT_EQ(ask(server.port(), "GET", place + query).status, 400) << query;
  }
}

}  // namespace
}  // namespace overfly::testing
