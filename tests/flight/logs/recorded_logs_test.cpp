// Recorded logs beside the repository: what is found in them, and one flight seen by two formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/log_trajectory.hpp"
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

std::string attitude_of(const OpenedLog& log) {
  return log.truth && log.truth->attitude ? log.streams[*log.truth->attitude].description.name
                                          : "none";
}

void print_warnings(const OpenedLog& log) {
  std::printf("%s: %zu streams, truth %s with %s\n",
              log.file.filename().c_str(),
              log.streams.size(),
              truth_of(log).c_str(),
              attitude_of(log).c_str());
  for (const std::string& warning : log.warnings) std::printf("  %s\n", warning.c_str());
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
  return {metres.size(), metres[metres.size() / 2], metres.back(), degrees[degrees.size() / 2],
          degrees.back()};
}

void print(const std::string& what, const Agreement& agreement) {
  std::printf("%s: %zu compared, position median %.3f m, max %.3f m, attitude median %.3f deg, max %.3f deg\n",
              what.c_str(), agreement.compared, agreement.position_median_m,
              agreement.position_max_m, agreement.attitude_median_deg, agreement.attitude_max_deg);
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
  print_warnings(*tlog);
  print_warnings(*bin);
  const LogTrajectory sim_state = trajectory_of(*tlog, "SIM_STATE");
  const LogTrajectory sim = trajectory_of(*bin, "SIM");
  const LogTrajectory sim2 = trajectory_of(*bin, "SIM2");
  const Agreement truth = compare(sim, sim_state);
  print("SIM against SIM_STATE", truth);
  const Agreement grids = compare(sim, sim2);
  print("SIM against SIM2", grids);
  const Agreement local = compare(trajectory_of(*bin, "XKF1"), trajectory_of(*tlog, "LOCAL_POSITION_NED"));
  print("XKF1[0] against LOCAL_POSITION_NED", local);
  print("POS against GLOBAL_POSITION_INT",
        compare(trajectory_of(*bin, "POS"), trajectory_of(*tlog, "GLOBAL_POSITION_INT")));
  print("truth SIM against estimate XKF1[0]", compare(sim, trajectory_of(*bin, "XKF1")));
  print("truth SIM against estimate POS", compare(sim, trajectory_of(*bin, "POS")));
  print("truth SIM against GPS", compare(sim, trajectory_of(*bin, "GPS")));
}

TEST(RecordedLogs, AllFormatsOpen) {
  for (const char* name : {"pilot_0004.BIN", "log171.bin", "vtol.tlog", "dronekit_flight_replay.tlog"}) {
    OVERFLY_DATA_OR_SKIP(file, std::string("flight_logs/formats/") + name);
    const Result<OpenedLog> log = open_log(file);
    ASSERT_TRUE(log.ok()) << log.error().message;
    print_warnings(*log);
    for (const StreamInfo& s : log->streams) {
      if (s.positions + s.attitudes + s.invalid > 0)
        std::printf("   %s %lu pos %lu att %lu inv %lu rate %.2f gaps %lu %.2f back %lu reach %.1f h %.1f..%.1f\n", s.description.name.c_str(), s.messages, s.positions, s.attitudes, s.invalid, s.rate_hz, s.gaps, 1e-9*s.longest_gap_ns, s.backward, s.reach_m, s.lowest_m, s.highest_m);
    }
    for (std::size_t i=0;i<std::min<std::size_t>(8,log->events.size());++i) std::printf("   ev %s\n", log->events[i].text.c_str());
    (void)messages_of(*log, "");
  }
}

}  // namespace
}  // namespace overfly::flight::logs
