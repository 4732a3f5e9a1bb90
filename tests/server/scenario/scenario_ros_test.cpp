// Flights from ROS topics in scenarios.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/pose.hpp"
#include "server/scenario/document/estimators/estimator_reach.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

using ::testing::HasSubstr;
using testing::small_scenario;

std::string refusal(const std::vector<std::string>& changes) {
  try {
    (void)small_scenario(changes);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ScenarioRos, HasTheTopicsOfMavros) {
  const Scenario scenario = small_scenario({"flight.ros.position=global"});
  EXPECT_TRUE(scenario.is_live());
  const auto& flight = std::get<flight::ros_live::RosFlight>(scenario.flight);
  EXPECT_EQ(flight.master_uri, "http://127.0.0.1:11311");
  EXPECT_EQ(flight.position_topic(), "/mavros/global_position/global");
  EXPECT_EQ(flight.attitude_topic(), "/mavros/imu/data");
  EXPECT_EQ(flight.state_topic, "/mavros/state");
  EXPECT_EQ(flight.sensor_topics, flight::ros_live::RosFlight().sensor_topics);
  EXPECT_EQ(flight.gap_limit_ns, kNsPerS / 2);
  EXPECT_EQ(flight.patience.count(), 10000);
  EXPECT_TRUE(flight.stop_on_disarm);
  EXPECT_FALSE(flight.origin);
}

TEST(ScenarioRos, ReadsAllFields) {
  const Scenario scenario = small_scenario({R"(flight.ros={
    "master_uri": "http://10.0.0.2:11312", "node_name": "camera", "position": "pose",
    "attitude": "pose", "pose_topic": "/odom", "origin": {"lat_deg": 47, "lon_deg": 8,
    "alt_ellipsoid_m": 500}, "sensor_topics": ["/imu"], "gap_limit_s": 0.2, "patience_s": 3, "stop": {"on_disarm": false}})"});
  const auto& flight = std::get<flight::ros_live::RosFlight>(scenario.flight);
  EXPECT_EQ(flight.master_uri, "http://10.0.0.2:11312");
  EXPECT_EQ(flight.node_name, "camera");
  EXPECT_EQ(flight.position_topic(), "/odom");
  EXPECT_EQ(flight.attitude_topic(), "/odom");
  EXPECT_EQ(flight.sensor_topics, std::vector<std::string>{"/imu"});
  ASSERT_TRUE(flight.origin);
  EXPECT_NEAR(flight.origin->lat_rad, rad_from_deg(47.0), 1e-15);
  EXPECT_EQ(flight.gap_limit_ns, 200'000'000);
  EXPECT_EQ(flight.patience.count(), 3000);
  EXPECT_FALSE(flight.stop_on_disarm);
}

TEST(ScenarioRos, NamesWhatIsWrong) {
  EXPECT_THAT(refusal({"flight.ros.patience_s=0"}), HasSubstr("flight.ros.patience_s = 0"));
  EXPECT_THAT(refusal({"flight.ros.position=elsewhere"}), HasSubstr("flight.ros.position"));
  EXPECT_THAT(refusal({R"(flight.ros.sensor_topics=[""])"}), HasSubstr("flight.ros.sensor_topics"));
  EXPECT_THAT(refusal({"flight.ros.topic=/a"}), HasSubstr("no such field"));
  EXPECT_THAT(refusal({R"(flight.ros.origin={"lat_deg": 1, "lon_deg": 2, "alt_ellipsoid_m": 3})"}),
              HasSubstr("flight.ros.origin: applies to position = \"pose\" only"));
}

TEST(ScenarioRos, MayBeChangedByClientsOnlyWithCommands) {
  const Scenario ros = small_scenario({"flight.ros.position=global"});
  const Scenario elsewhere = small_scenario({"flight.ros.master_uri=http://10.0.0.2:11311"});
  EXPECT_TRUE(check_reach(ros, {ros}).ok());
  const Status refused = check_reach(elsewhere, {ros});
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("flight.ros: must be as in the scenario's file"));
  EXPECT_FALSE(check_reach(ros, {small_scenario()}).ok());
}

}  // namespace
}  // namespace overfly::server
