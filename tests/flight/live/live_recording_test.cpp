// The flight of a live vehicle compared with its recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "flight/live/live_truth.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "flight/mavlink/link/frame_recorder.hpp"
#include "tests/flight/live/made_vehicle.hpp"
#include "tests/flight/mavlink/replay_vehicle.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::live {
namespace {

using overfly::testing::larger_error;
using testing::append;
using testing::Bytes;
using ::testing::ElementsAre;
using testing::frame_bytes;
using testing::PeerSocket;

TEST(LiveTruth, IsFlownAgainFromItsRecording) {
  const overfly::testing::TemporaryFolder folder;
  const auto tlog = folder.path() / "vehicle.tlog";
  auto recorder = mavlink::FrameRecorder::create(tlog);
  ASSERT_TRUE(recorder.ok()) << recorder.error().message;
  LiveTruthOptions options;
  options.recorder = std::move(*recorder);
  std::map<std::int64_t, Pose> flown;  // by the vehicle's clock
  {
    OpenedTruth live(options);
    ASSERT_NE(live.truth, nullptr);
    live.fly_until(live.last_ms + 3000);
    for (std::int64_t t_ns = live.truth->start_ns(); t_ns <= std::int64_t{live.last_ms} * 1'000'000;
         t_ns += 20'000'000) {
      const auto state = live.truth->state_at(t_ns - live.truth->start_ns());
      ASSERT_TRUE(state.ok() && *state);
      flown[t_ns] = (*state)->T_world_body;
    }
    EXPECT_THAT(live.truth->warnings(), ElementsAre());
  }
  options.recorder.reset();  // the last messages are in the file now
  const auto log = logs::open_log(tlog);
  ASSERT_TRUE(log.ok()) << log.error().message;
  const auto again = logs::read_log_trajectory(*log, {"", flown.begin()->first, {}}, nullptr);
  ASSERT_TRUE(again.ok()) << again.error().message;
  const LocalFrame frame = frame_at_start();
  std::size_t compared = 0;
  for (const logs::LogPose& pose : again->poses) {
    const auto then = flown.find(pose.t_ns);
    if (then == flown.end()) continue;
    ++compared;
    const Geodetic point =
        geodetic_from_deg(pose.position.x(), pose.position.y(), pose.position.z());
    EXPECT_LT((frame.world_from_geodetic(point) - then->second.translation).norm(), 1e-9);
    const Eigen::Quaterniond R = frame.R_world_enu_at(point) * logs::R_enu_ned() * pose.R_ned_body;
    EXPECT_LT(rotation_angle_rad(R, then->second.rotation), 1e-7);
  }
  EXPECT_GE(compared, 150U);
}

/// What a recording gives as truth, by the same vehicle's clock.
logs::LogTrajectory recorded(const std::filesystem::path& file, const std::string& source) {
  const Result<logs::OpenedLog> log = logs::open_log(file);
  EXPECT_TRUE(log.ok());
  const auto trajectory = logs::read_log_trajectory(*log, {source, {}, {}});
  EXPECT_TRUE(trajectory.ok());
  return *trajectory;
}

struct Differences {
  std::size_t compared = 0;
  double position_m = 0.0;
  double attitude_deg = 0.0;
};

/// Compares a live flight with the poses of the recording at their times.
Differences differences(LiveTruth& truth, const logs::LogTrajectory& log, std::int64_t until_ns) {
  const LocalFrame frame = frame_at_start();
  Differences found;
  for (const logs::LogPose& pose : log.poses) {
    const std::int64_t t_ns = pose.t_ns - truth.start_ns();
    if (t_ns < 0) continue;
    if (pose.t_ns > until_ns) break;
    const auto state = truth.state_at(t_ns);
    EXPECT_TRUE(state.ok()) << (state.ok() ? "" : state.error().message);
    if (!state.ok() || !*state) break;
    const Geodetic point =
        geodetic_from_deg(pose.position.x(), pose.position.y(), pose.position.z());
    const Eigen::Quaterniond R_world_body =
        frame.R_world_enu_at(point) * logs::R_enu_ned() * pose.R_ned_body;
    ++found.compared;
    found.position_m = larger_error(
        found.position_m,
        ((*state)->T_world_body.translation - frame.world_from_geodetic(point)).norm());
    found.attitude_deg = larger_error(
        found.attitude_deg,
        deg_from_rad(rotation_angle_rad((*state)->T_world_body.rotation, R_world_body)));
  }
  return found;
}

/// Sends the recording by TCP, which loses nothing, with garbage and another system's messages
/// between the frames.
Differences replay_by_tcp(const std::filesystem::path& file,
                          TruthPreference preference,
                          const std::string& source,
                          std::size_t frames) {
  const auto vehicle = listening_vehicle("tcp-listen:127.0.0.1:0");
  std::thread sender([&] {
    PeerSocket socket(SOCK_STREAM);
    if (!socket.connect_to(vehicle->address().port)) return;
    std::size_t sent = 0;
    testing::for_each_frame(file, [&](const mavlink::Frame&, std::span<const std::uint8_t> bytes) {
      Bytes out(bytes.begin(), bytes.end());
      if (sent % 100 == 50) append(out, {0xFD, 0x00, 0xFF, 0x13, 0xFE, 0x09});
      if (sent % 30 == 10)
        append(out, frame_bytes(30, testing::attitude_payload(5, 3, 3, 3), 0, 77));
      return socket.send(out) && ++sent < frames;
    });
  });
  LiveTruthOptions options;
  options.truth = preference;
  auto truth = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
  Differences found;
  EXPECT_TRUE(truth.ok()) << truth.error().message;
  if (truth.ok()) found = differences(**truth, recorded(file, source), 200 * kNsPerS);
  sender.join();
  const mavlink::VehicleState state = vehicle->state();
  std::printf(
      "%s: %zu poses compared, largest difference %.6f m, %.6f deg, %llu messages, %llu lost\n",
      source.c_str(),
      found.compared,
      found.position_m,
      found.attitude_deg,
      static_cast<unsigned long long>(state.messages),
      static_cast<unsigned long long>(state.lost_messages));
  return found;
}

TEST(LiveTruth, EqualsTheRecordingOfTheSameMessages) {
  OVERFLY_DATA_OR_SKIP(file, "sitl/plane25.tlog");
  const Differences truth = replay_by_tcp(file, TruthPreference::kSimulation, "SIM_STATE", 110'000);
  EXPECT_GT(truth.compared, 3000U);
  EXPECT_LT(truth.position_m, 1e-6);
  EXPECT_LT(truth.attitude_deg, 1e-4);  // recordings keep attitudes as floats
  const Differences estimate =
      replay_by_tcp(file, TruthPreference::kEstimate, "GLOBAL_POSITION_INT", 110'000);
  EXPECT_GT(estimate.compared, 100U);
  EXPECT_LT(estimate.position_m, 1e-6);
  EXPECT_LT(estimate.attitude_deg, 1e-4);
}

}  // namespace
}  // namespace overfly::flight::live
