// Recorded logs next to the repository: what they contain, and one flight recorded in two formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

const StreamInfo* stream_named(const OpenedLog& log, const std::string& name) {
  for (const StreamInfo& stream : log.streams) {
    if (stream.description.name == name) return &stream;
  }
  return nullptr;
}

std::uint64_t messages_of(const OpenedLog& log, const std::string& name) {
  const StreamInfo* const stream = stream_named(log, name);
  return stream == nullptr ? 0 : stream->messages;
}

std::string truth_of(const OpenedLog& log) {
  return log.truth ? log.streams[log.truth->position].description.name : "none";
}

/// Metres between two geodetic positions nearby.
double distance_m(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double m_per_deg = 111195.0;
  return Eigen::Vector3d((a.x() - b.x()) * m_per_deg,
                         (a.y() - b.y()) * m_per_deg * std::cos(rad_from_deg(a.x())),
                         a.z() - b.z())
      .norm();
}

struct Agreement {
  std::size_t compared = 0;
  double position_median_m = 0.0;
  double position_max_m = 0.0;
  double attitude_median_deg = 0.0;
  double attitude_max_deg = 0.0;
};

/// Compares `a` with `b` interpolated at its times, from 60 s to 450 s of the clock.
Agreement compare(const LogTrajectory& a, const LogTrajectory& b) {
  std::vector<double> metres;
  std::vector<double> degrees;
  for (const LogPose& pose : a.poses) {
    if (pose.t_ns < 60 * kNsPerS || pose.t_ns > 450 * kNsPerS) continue;
    const auto after = std::lower_bound(
        b.poses.begin(), b.poses.end(), pose.t_ns, [](const LogPose& candidate, std::int64_t t) {
          return candidate.t_ns < t;
        });
    if (after == b.poses.begin() || after == b.poses.end()) continue;
    const LogPose& before = *(after - 1);
    const double part = static_cast<double>(pose.t_ns - before.t_ns) /
                        static_cast<double>(after->t_ns - before.t_ns);
    metres.push_back(
        distance_m(pose.position, before.position + part * (after->position - before.position)));
    degrees.push_back(deg_from_rad(
        rotation_angle_rad(pose.R_ned_body, before.R_ned_body.slerp(part, after->R_ned_body))));
  }
  std::sort(metres.begin(), metres.end());
  std::sort(degrees.begin(), degrees.end());
  if (metres.empty()) return {};
  return {metres.size(),
          metres[metres.size() / 2],
          metres.back(),
          degrees[degrees.size() / 2],
          degrees.back()};
}

void print(const std::string& what, const Agreement& agreement) {
  std::printf(
      "%s: %zu compared, position median %.3f m, max %.3f m, attitude median %.3f deg, max %.3f "
      "deg\n",
      what.c_str(),
      agreement.compared,
      agreement.position_median_m,
      agreement.position_max_m,
      agreement.attitude_median_deg,
      agreement.attitude_max_deg);
}

LogTrajectory trajectory_of(const OpenedLog& log, const std::string& source) {
  const Result<LogTrajectory> read = read_log_trajectory(log, {source, {}, {}});
  EXPECT_TRUE(read.ok()) << (read.ok() ? "" : read.error().message);
  return read.ok() ? *read : LogTrajectory{};
}

TEST(RecordedLogs, OneFlightAgreesBetweenTlogAndDataFlash) {
  OVERFLY_DATA_OR_SKIP(tlog_file, "sitl/plane25.tlog");
  OVERFLY_DATA_OR_SKIP(bin_file, "sitl/plane25.BIN");
  const Result<OpenedLog> tlog = open_log(tlog_file);
  const Result<OpenedLog> bin = open_log(bin_file);
  ASSERT_TRUE(tlog.ok()) << tlog.error().message;
  ASSERT_TRUE(bin.ok()) << bin.error().message;
  EXPECT_EQ(truth_of(*tlog), "1.1/SIM_STATE");
  EXPECT_EQ(truth_of(*bin), "SIM");
  const LogTrajectory sim_state = trajectory_of(*tlog, "SIM_STATE");
  const LogTrajectory sim = trajectory_of(*bin, "SIM");
  const LogTrajectory estimate = trajectory_of(*bin, "XKF1");

  // The simulator's state by two ways: SIM_STATE has no time of its own.
  const Agreement truth = compare(sim, sim_state);
  print("SIM against SIM_STATE", truth);
  EXPECT_GT(truth.compared, 9000U);
  EXPECT_LT(truth.position_max_m, 0.1);
  EXPECT_LT(truth.attitude_max_deg, 0.1);
  // Metres from the simulator's start, with the scale of ArduPilot.
  const Agreement grid = compare(sim, trajectory_of(*bin, "SIM2"));
  print("SIM against SIM2", grid);
  EXPECT_LT(grid.position_max_m, 0.1);
  // The estimate by two ways, in metres and geodetic.
  const Agreement local = compare(estimate, trajectory_of(*tlog, "LOCAL_POSITION_NED"));
  print("XKF1[0] against LOCAL_POSITION_NED", local);
  EXPECT_LT(local.position_max_m, 0.5);
  EXPECT_LT(local.attitude_max_deg, 0.5);
  const Agreement global =
      compare(trajectory_of(*bin, "POS"), trajectory_of(*tlog, "GLOBAL_POSITION_INT"));
  print("POS against GLOBAL_POSITION_INT", global);
  EXPECT_LT(global.position_max_m, 0.5);
  EXPECT_LT(global.attitude_max_deg, 0.5);

  // The estimator's own error, which is why it is not taken as truth.
  const Agreement error = compare(sim, estimate);
  print("SIM against XKF1[0]", error);
  print("SIM against GPS", compare(sim, trajectory_of(*bin, "GPS")));
  EXPECT_GT(error.position_max_m, 10.0 * truth.position_max_m);
}

/// What an independent count of a recorded log gives.
struct Counted {
  const char* file;
  const char* stream;
  std::uint64_t messages;
};

TEST(RecordedLogs, HaveTheCountedMessages) {
  const Counted all[] = {{"formats/pilot_0004.BIN", "ATT", 2375},
                         {"formats/pilot_0004.BIN", "XKF1[0]", 2355},
                         {"formats/pilot_0004.BIN", "FMTU", 161},
                         {"formats/pilot_0004.BIN", "POS", 362},
                         {"formats/log171.bin", "IMU3", 11916},
                         {"formats/log171.bin", "GPS", 1199},
                         {"formats/log171.bin", "EKF1", 2383},
                         {"formats/log171.bin", "PARM", 491},
                         {"formats/vtol.tlog", "1.1/SIMSTATE", 889},
                         {"formats/vtol.tlog", "1.1/AHRS3", 888},
                         {"formats/vtol.tlog", "1.1/ATTITUDE", 888},
                         {"formats/dronekit_flight_replay.tlog", "1.1/GPS_RAW_INT", 2858},
                         {"formats/dronekit_flight_replay.tlog", "255.0/id 142", 1314},
                         {"formats/dronekit_flight_replay.tlog", "51.68/RADIO_STATUS", 1370}};
  std::string opened;
  std::optional<OpenedLog> log;
  for (const Counted& counted : all) {
    OVERFLY_DATA_OR_SKIP(file, std::string("flight_logs/") + counted.file);
    if (opened != counted.file) {
      Result<OpenedLog> read = open_log(file);
      ASSERT_TRUE(read.ok()) << read.error().message;
      log = std::move(read).value();
      opened = counted.file;
    }
    EXPECT_EQ(messages_of(*log, counted.stream), counted.messages)
        << counted.file << " " << counted.stream;
  }
}

TEST(RecordedLogs, OfAnAircraftOnTheGroundSaySo) {
  OVERFLY_DATA_OR_SKIP(file, "flight_logs/formats/pilot_0004.BIN");
  const Result<OpenedLog> log = open_log(file);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_TRUE(log->on_ground);
  EXPECT_EQ(truth_of(*log), "POS");
  EXPECT_EQ(log->streams[log->truth->position].invalid, 0U);
}

TEST(RecordedLogs, ShowTheRestartOfACopter) {
  OVERFLY_DATA_OR_SKIP(file, "flight_logs/formats/dronekit_flight_replay.tlog");
  const Result<OpenedLog> log = open_log(file);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(truth_of(*log), "1.1/GLOBAL_POSITION_INT");
  EXPECT_FALSE(log->on_ground);
  std::size_t runs = 0;
  for (const BootInfo& boot : log->boots) runs += boot.vehicle == "1.1" ? 1 : 0;
  EXPECT_EQ(runs, 2U);
}

TEST(RecordedLogs, TakeTheSimulatorsAttitudeWithAnEstimatedPosition) {
  OVERFLY_DATA_OR_SKIP(file, "flight_logs/formats/vtol.tlog");
  const Result<OpenedLog> log = open_log(file);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(truth_of(*log), "1.1/GLOBAL_POSITION_INT");
  ASSERT_TRUE(log->truth->attitude);
  EXPECT_EQ(log->streams[*log->truth->attitude].description.name, "1.1/SIMSTATE");
}

}  // namespace
}  // namespace overfly::flight::logs
