// Estimates sent back to the built-in vehicle over the loopback interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <thread>

#include "flight/live/fly_live.hpp"
#include "flight/mavlink/link/frame_link.hpp"
#include "flight/mavlink/payload.hpp"
#include "flight/vehicle/simulated_vehicle.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::flight::live {
namespace {

using ::testing::HasSubstr;

/// The built-in vehicle, which moves on whenever its link has nothing to do. Keeps the estimates
/// that it gets.
class ListeningVehicle {
 public:
  struct Received {
    std::uint32_t id = 0;
    std::vector<std::uint8_t> payload;
  };

  ListeningVehicle() {
    vehicle::VehicleSetup setup;
    setup.airframe = dynamics::testing::airframe("piper_cub_third");
    setup.airspeed_m_s = 20.0;
    setup.home = geodetic_from_deg(10.0, 20.0, 100.0);
    auto created = vehicle::SimulatedVehicle::create(setup);
    vehicle_ = std::move(*created);
    mavlink::LinkOptions options;
    options.system = 1;
    options.component = 1;
    auto opened =
        mavlink::FrameLink::create(*mavlink::parse_link_address("tcp-listen:127.0.0.1:0", "link"),
                                   options,
                                   mavlink::LinkClock::now());
    link_ = std::move(*opened);
    address_ = "tcp:127.0.0.1:" + std::to_string(link_->address().port);
    thread_ = std::thread([this] { run(); });
  }
  ~ListeningVehicle() {
    stops_ = true;
    thread_.join();
  }
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] std::vector<Received> received() {
    const std::lock_guard lock(mutex_);
    return received_;
  }

 private:
  void run() {
    const vehicle::Send send =
        [&](mavlink::MessageId id, const mavlink::PayloadWriter& payload, std::uint8_t system) {
          (void)link_->send(static_cast<std::uint32_t>(id), payload.bytes(), system);
        };
    while (!stops_) {
      vehicle_->step(send);
      link_->step(
          mavlink::LinkClock::now(),
          std::chrono::milliseconds(1),
          [&](const mavlink::Frame& frame) {
            vehicle_->take(frame, send);
            if (frame.message_id != 331 && frame.message_id != 102) return;
            const std::lock_guard lock(mutex_);
            received_.push_back({frame.message_id, {frame.payload.begin(), frame.payload.end()}});
          });
    }
  }

  std::unique_ptr<vehicle::SimulatedVehicle> vehicle_;
  std::unique_ptr<mavlink::FrameLink> link_;
  std::string address_;
  std::atomic<bool> stops_{false};
  std::mutex mutex_;
  std::vector<Received> received_;
  std::thread thread_;
};

TEST(FeedbackFlight, ReachesTheVehicleWithTheCapturesTime) {
  ListeningVehicle vehicle;
  LiveFlight flight;
  flight.link = *mavlink::parse_link_address(vehicle.address(), "link");
  flight.rate_hz = 50.0;
  mavlink::FeedbackOptions feedback;
  feedback.message = mavlink::FeedbackMessage::kOdometry;
  feedback.latency_ns = 40'000'000;
  feedback.send_height = true;
  flight.feedback = feedback;
  const LocalFrame frame(geodetic_from_deg(10.0, 20.0, 100.0));
  const auto truth = fly_live(flight, frame, nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const auto receiver = (*truth)->estimate_receiver();
  ASSERT_TRUE(receiver);
  // Ten frames of 10 Hz; the estimator is right about the place and restarts in the middle.
  std::map<std::uint64_t, int> maps_by_time_us;
  std::vector<std::int64_t> times_ns;
  for (int k = 0; k < 10; ++k) {
    const std::int64_t t_ns = k * kNsPerS / 10;
    const auto state = (*truth)->state_at(t_ns);
    ASSERT_TRUE(state.ok() && *state);
    EXPECT_TRUE((*truth)->heard_ns());
    Pose pose = (*state)->T_world_body;
    pose.translation += Eigen::Vector3d(7.0, 0.0, 0.0);  // its error
    receiver->take({t_ns, k < 5 ? 0 : 1, pose});
    times_ns.push_back(t_ns);
  }
  for (int i = 0; i < 2000 && vehicle.received().size() < 10; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const auto received = vehicle.received();
  // A machine that stands still for half a second makes estimates too old to be sent.
  ASSERT_GE(received.size(), 2U) << receiver->report();
  const mavlink::PayloadReader first(received.front().payload);
  const auto start_us = static_cast<std::int64_t>(first.at<std::uint64_t>(0));
  for (const auto& message : received) {
    EXPECT_EQ(message.id, 331U);
    const mavlink::PayloadReader payload(message.payload);
    const auto since_us = static_cast<std::int64_t>(payload.at<std::uint64_t>(0)) - start_us;
    EXPECT_EQ(since_us % 100'000, 0) << "captures are 0.1 s apart";
    EXPECT_NEAR(payload.at<float>(8), 0.0, 1e-3);
    EXPECT_NEAR(payload.at<float>(12), 7.0, 0.05);
    EXPECT_NEAR(payload.at<float>(16), 0.0, 0.3);
    EXPECT_LE(payload.at<std::uint8_t>(230), 1);
  }
  EXPECT_THAT(receiver->report(),
              HasSubstr("sent " + std::to_string(received.size()) + " ODOMETRY to vehicle 1.1"));
  EXPECT_THAT(receiver->report(), HasSubstr("1 resets"));
}

}  // namespace
}  // namespace overfly::flight::live
