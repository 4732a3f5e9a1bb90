#include "core/earth/geodesy.hpp"
#include "core/motion/pose.hpp"
#include "core/text/number_text.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "flight/logs/whole_file.hpp"

namespace overfly::flight::logs {
namespace {

namespace fs = std::filesystem;

Geodetic geodetic_of(const Eigen::Vector3d& position) {
  return geodetic_from_deg(position.x(), position.y(), position.z());
}

std::string tum_row(std::int64_t t_ns, const Pose& pose) {
  const Eigen::Vector3d& p = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  std::string row = seconds_text(t_ns);
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) {
    row += ' ' + number_text(value);
  }
  return row += '\n';
}

const char* height_column(HeightDatum datum) {
  return datum == HeightDatum::kEllipsoid ? "alt_ellipsoid_m" : "alt_msl_m";
}

std::string sources_of(const LogTrajectory& trajectory) {
  return "# position_source " + trajectory.position_source + "\n# attitude_source " +
         trajectory.attitude_source + "\n";
}

}  // namespace

Trajectory world_trajectory(const LogTrajectory& trajectory) {
  Trajectory world;
  if (trajectory.poses.empty()) return world;
  const Eigen::Vector3d first = trajectory.poses.front().position;
  const LocalFrame frame(trajectory.georeferenced ? geodetic_of(first) : Geodetic{});
  for (const LogPose& pose : trajectory.poses) {
    const Eigen::Quaterniond R_enu_body = R_enu_ned() * pose.R_ned_body;
    StampedPose stamped{pose.t_ns, {R_enu_body, Eigen::Vector3d::Zero()}};
    if (trajectory.georeferenced) {
      const Geodetic point = geodetic_of(pose.position);
      stamped.pose = {frame.R_world_enu_at(point) * R_enu_body, frame.world_from_geodetic(point)};
    } else {
      const Eigen::Vector3d ned_m = pose.position - first;
      stamped.pose.translation = {ned_m.y(), ned_m.x(), -ned_m.z()};
    }
    // The times increase, and what is not finite is not among the poses of a log.
    (void)world.append(stamped);
  }
  return world;
}

Status write_log_tum(const fs::path& file, const LogTrajectory& trajectory) {
  return write_whole_file(file, [&](std::ofstream& out) {
    out << "# pose T_world_body: world east-north-up, body forward-right-down\n"
        << sources_of(trajectory);
    if (trajectory.poses.empty()) return;
    if (trajectory.georeferenced) {
      const Eigen::Vector3d& first = trajectory.poses.front().position;
      out << "# origin_lat_deg " << number_text(first.x()) << "\n# origin_lon_deg "
          << number_text(first.y()) << "\n# origin_" << height_column(trajectory.height) << " "
          << number_text(first.z()) << "\n";
    }
    const Trajectory world = world_trajectory(trajectory);
    for (const StampedPose& stamped : world.poses()) {
      out << tum_row(stamped.t_ns, stamped.pose);
    }
  });
}

Status write_log_csv(const fs::path& file,
                     const LogTrajectory& trajectory,
                     std::optional<double> geoid_separation_m) {
  if (!trajectory.georeferenced) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": the positions of " + trajectory.position_source +
                     " count from an origin that the log does not state: only a .tum file can "
                     "hold them"};
  }
  if (geoid_separation_m && trajectory.height == HeightDatum::kEllipsoid) {
    return Error{ErrorCode::kInvalidArgument,
                 file.string() + ": the heights of " + trajectory.position_source +
                     " are above the ellipsoid already: no geoid separation must be given"};
  }
  const double separation_m = geoid_separation_m.value_or(0.0);
  const HeightDatum height = geoid_separation_m ? HeightDatum::kEllipsoid : trajectory.height;
  return write_whole_file(file, [&](std::ofstream& out) {
    out << "t_s,lat_deg,lon_deg," << height_column(height) << ",roll_deg,pitch_deg,yaw_deg\n";
    for (const LogPose& pose : trajectory.poses) {
      const RollPitchYaw angles = attitude_from(R_enu_ned() * pose.R_ned_body);
      std::string row = seconds_text(pose.t_ns);
      for (const double value : {pose.position.x(),
                                 pose.position.y(),
                                 pose.position.z() + separation_m,
                                 deg_from_rad(angles.roll_rad),
                                 deg_from_rad(angles.pitch_rad),
                                 deg_from_rad(angles.yaw_rad)}) {
        row += ',' + number_text(value);
      }
      out << row << '\n';
    }
  });
}

}  // namespace overfly::flight::logs
