#include <cmath>
#include <cstdio>
#include <utility>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/logs/whole_file.hpp"
#include "flight/replay/smooth_log.hpp"

namespace overfly::flight {
namespace {

std::string fixed_text(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::int64_t vehicle_ns(const SmoothedLog& log, double t_s) {
  return log.epoch_ns + ns_from_s(t_s);
}

}  // namespace

Result<logs::LogTrajectory> sampled_trajectory(const SmoothedLog& log, double rate_hz) {
  const double duration_s = s_from_ns(log.end_ns() - log.begin_ns());
  if (!(rate_hz > 0.0 && rate_hz <= 1000.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 "rate = " + number_text(rate_hz) + " Hz: must be in (0, 1000]"};
  }
  const double count = std::floor(duration_s * rate_hz) + 1.0;
  if (count > static_cast<double>(kMaxSampledPoses)) {
    return Error{ErrorCode::kInvalidArgument,
                 "rate = " + number_text(rate_hz) + " Hz: more than " +
                     std::to_string(kMaxSampledPoses) + " poses; limit the times"};
  }
  const Result<FrameRate> rate = FrameRate::from_hz(rate_hz);
  if (!rate) return rate.error();
  logs::LogTrajectory trajectory;
  trajectory.georeferenced = true;
  trajectory.height = log.height;
  trajectory.position_source = log.position_source;
  trajectory.attitude_source = log.attitude_source;
  trajectory.boot = log.boot;
  trajectory.poses.reserve(static_cast<std::size_t>(count));
  for (std::int64_t k = 0;; ++k) {
    const std::int64_t t_ns = log.begin_ns() + frame_time_ns(k, *rate);
    if (t_ns > log.end_ns()) break;
    const smoothing::MotionState state = log.smoothed.motion.at(s_from_ns(t_ns - log.epoch_ns));
    const Geodetic point = log.frame.geodetic_from_world(state.p_world_m);
    trajectory.poses.push_back({t_ns,
                                {deg_from_rad(point.lat_rad),
                                 deg_from_rad(point.lon_rad),
                                 point.alt_ellipsoid_m - log.geoid_separation_m},
                                state.R_ned_body});
  }
  return trajectory;
}

Status write_residuals(const std::filesystem::path& file, const SmoothedLog& log) {
  return logs::write_whole_file(file, [&](std::ofstream& out) {
    out << "t_s,kind,used,shifted,east_m,north_m,up_m,x_deg,y_deg,z_deg\n";
    const auto write = [&](const smoothing::FitReport& report, bool position) {
      for (const smoothing::SampleResidual& row : report.residuals) {
        out << seconds_text(vehicle_ns(log, row.t_s)) << (position ? ",position," : ",attitude,")
            << row.used << ',' << row.shifted << (position ? "," : ",,,,");
        for (int i = 0; i < 3; ++i) {
          const double value = position ? row.residual[i] : deg_from_rad(row.residual[i]);
          out << (i > 0 ? "," : "") << number_text(value);
        }
        out << (position ? ",,,\n" : "\n");
      }
    };
    write(log.smoothed.positions, true);
    write(log.smoothed.attitudes, false);
  });
}

std::string jump_text(const SmoothedLog& log, const smoothing::Jump& jump) {
  const std::string at = " at " + fixed_text(s_from_ns(vehicle_ns(log, jump.t_s)), 3) + " s";
  const std::string metres = fixed_text(jump.size, 1) + " m";
  const std::string degrees = fixed_text(deg_from_rad(jump.size), 1) + " deg";
  switch (jump.kind) {
    case smoothing::JumpKind::kPositionOutliers:
      return counted(jump.samples, "position") + " left out" + at + ": up to " + metres + " off";
    case smoothing::JumpKind::kPositionStep:
      return "step of the positions by " + metres + at;
    case smoothing::JumpKind::kAttitudeOutliers:
      return counted(jump.samples, "attitude") + " left out" + at + ": up to " + degrees + " off";
    case smoothing::JumpKind::kYawStep:
      break;
  }
  return "step of the yaw by " + degrees + at;
}

}  // namespace overfly::flight
