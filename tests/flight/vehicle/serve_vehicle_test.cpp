// The simulated vehicle on a link: flown as truth, and by an independent ground station.
#include "flight/vehicle/serve_vehicle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "flight/live/fly_live.hpp"
#include "tests/flight/mavlink/peer/peer_script.hpp"
#include "tests/flight/vehicle/cub_at_home.hpp"
#include "tests/support/support.hpp"

namespace overfly::vehicle {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A vehicle that flies 20 times as fast as the wall clock, on a port of the loopback interface.
class ServedVehicle {
 public:
  ServedVehicle() {
    const auto address =
        flight::mavlink::parse_link_address("tcp-listen:127.0.0.1:0", "link").value();
    thread_ = std::thread([this, address] {
      served = serve_vehicle(
          *vehicle_, address, 20.0, stop_, [this](const auto& opened) { port_ = opened.port; });
    });
    while (port_ == 0) std::this_thread::yield();
  }
  ~ServedVehicle() { stop(); }

  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] std::string port() const { return std::to_string(port_.load()); }

  Status served;

 private:
  std::unique_ptr<SimulatedVehicle> vehicle_ = SimulatedVehicle::create(cub_at_home()).value();
  std::atomic<bool> stop_ = false;
  std::atomic<int> port_ = 0;
  std::thread thread_;
};

TEST(ServeVehicle, IsFlownAsTruthOverTcp) {
  ServedVehicle vehicle;
  flight::live::LiveFlight flight;
  flight.link =
      flight::mavlink::parse_link_address("tcp:127.0.0.1:" + vehicle.port(), "link").value();
  flight.mission_file =
      overfly::testing::source_file("scenarios/missions/airfield_pattern.waypoints");
  flight.parameters = {{"RLL2SRV_RMAX", 50.0}};
  flight.arm_and_start = true;
  const LocalFrame frame(cub_at_home().home);
  auto truth = flight::live::fly_live(flight, frame, nullptr);
  EXPECT_TRUE(truth.ok()) << (truth ? "" : truth.error().message);
  if (truth) {
    EXPECT_THAT((*truth)->description(), HasSubstr("SIM_STATE"));
    double highest = 0.0;
    for (std::int64_t t = 0; t < 20'000'000'000; t += 100'000'000) {
      const auto state = (*truth)->state_at(t);
      ASSERT_TRUE(state.ok() && *state) << (state ? "ended" : state.error().message);
      highest = std::max(highest, (*state)->T_world_body.translation.z());
    }
    EXPECT_GT(highest, 30.0);
    EXPECT_LT(highest, 155.0);
  }
  vehicle.stop();
  EXPECT_TRUE(vehicle.served.ok());
}

TEST(ServeVehicle, IsPlannedStartedAndWatchedByAnIndependentGroundStation) {
  ServedVehicle vehicle;
  const std::vector<std::string> lines =
      flight::testing::lines_of_script("ground_station.cjs", vehicle.port());
  if (lines.empty()) GTEST_SKIP() << flight::testing::kPeerNotInstalled;
  EXPECT_THAT(lines,
              ElementsAre("heartbeat type=1 autopilot=3",
                          HasSubstr("roll_rate=true"),
                          "mission ack=0",
                          "command 400 result=0",
                          "command 300 result=0",
                          ::testing::StartsWith("climbed lat=393"),
                          "mode=10 armed=true"));
}

}  // namespace
}  // namespace overfly::vehicle
