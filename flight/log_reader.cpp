#include "flight/log_reader.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "core/motion/time_order.hpp"
#include "core/motion/trajectory_io.hpp"
#include "core/text/number_text.hpp"
#include "core/text/text_fields.hpp"
#include "core/time.hpp"

namespace overfly::flight {
namespace {

struct Column {
  const char* name;
  double low;
  double high;
};

constexpr std::array<Column, 7> kColumns{{{"t_s", 0.0, 0.0},
                                          {"lat_deg", -90.0, 90.0},
                                          {"lon_deg", -180.0, 360.0},
                                          {"alt_ellipsoid_m", -1000.0, 100000.0},
                                          {"roll_deg", -360.0, 360.0},
                                          {"pitch_deg", -90.0, 90.0},
                                          {"yaw_deg", -360.0, 360.0}}};

constexpr const char* kHeader = "t_s,lat_deg,lon_deg,alt_ellipsoid_m,roll_deg,pitch_deg,yaw_deg";

Status check_header(const FieldFile& file, const FieldLine& line) {
  const std::string wanted = std::string("the header must be ") + kHeader;
  if (line.fields.size() != kColumns.size()) return file.bad_line(line, wanted);
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    if (line.fields[i] != kColumns[i].name) return file.bad_field(line, i + 1, wanted);
  }
  return {};
}

Result<StampedPose> pose_from(const FieldFile& file,
                              const FieldLine& line,
                              const LocalFrame& frame) {
  if (Status status = file.expect_fields(line, kColumns.size()); !status) return status.error();
  const Result<std::int64_t> t_ns = file.time_s(line, 1);
  if (!t_ns) return t_ns.error();
  std::array<double, kColumns.size()> values{};
  for (std::size_t i = 1; i < kColumns.size(); ++i) {
    const Result<double> value = file.number(line, i + 1);
    if (!value) return value.error();
    values[i] = *value;
    if (*value >= kColumns[i].low && *value <= kColumns[i].high) continue;
    return file.bad_field(line,
                          i + 1,
                          std::string(kColumns[i].name) + " must be in [" +
                              std::to_string(static_cast<int>(kColumns[i].low)) + ", " +
                              std::to_string(static_cast<int>(kColumns[i].high)) + "]");
  }
  const Geodetic point = geodetic_from_deg(values[1], values[2], values[3]);
  const Eigen::Quaterniond R_enu_body = R_world_body_from(
      {rad_from_deg(values[4]), rad_from_deg(values[5]), rad_from_deg(values[6])});
  return StampedPose{*t_ns,
                     {frame.R_world_enu_at(point) * R_enu_body, frame.world_from_geodetic(point)}};
}

Result<FlightLog> read_csv(const FieldFile& file,
                           const std::string& name,
                           const LocalFrame& frame) {
  if (Status status = check_header(file, file.lines().front()); !status) return status.error();
  std::vector<StampedPose> poses;
  std::vector<TimedLine> times;
  for (std::size_t i = 1; i < file.lines().size(); ++i) {
    const FieldLine& line = file.lines()[i];
    const Result<StampedPose> stamped = pose_from(file, line, frame);
    if (!stamped) return stamped.error();
    poses.push_back(*stamped);
    times.push_back({stamped->t_ns, line.number});
  }
  TimeOrder order = order_by_time(name, "rows", times);
  FlightLog log;
  for (const std::size_t i : order.kept) {
    if (Status status = log.T_world_body.append(poses[i]); !status) {
      return file.bad_line(file.lines()[i + 1], status.error().message);
    }
  }
  log.warnings = std::move(order.warnings);
  return log;
}

/// A flight goes smoothly through gaps, however long they are.
void warn_of_gaps_in(const TrajectoryFile& file,
                     const std::string& name,
                     std::vector<std::string>& warnings) {
  const std::vector<StampedPose>& poses = file.trajectory.poses();
  std::int64_t longest_ns = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (!file.trajectory.has_gap_before(i)) continue;
    longest_ns = std::max(longest_ns, poses[i].t_ns - poses[i - 1].t_ns);
  }
  if (longest_ns == 0) return;
  warnings.push_back(name + ": " + counted(file.unknown_poses, "row") +
                     " without a pose: the gaps, the longest of " +
                     short_text(s_from_ns(longest_ns)) + " s, are bridged without any sample");
}

}  // namespace

Result<FlightLog> read_log(const std::filesystem::path& path,
                           const LocalFrame& frame,
                           bool camera_poses,
                           const std::atomic<bool>* cancel) {
  const Result<FieldFile> file = FieldFile::read(path, cancel);
  if (!file) return file.error();
  if (!file->lines().empty() && file->lines().front().fields.front() == kColumns[0].name) {
    return read_csv(*file, path.string(), frame);
  }
  const Result<TrajectoryFile> poses = read_trajectory(path, cancel);
  if (!poses) return poses.error();
  if (!poses->has_times) {
    return Error{
        ErrorCode::kUnreadable,
        path.string() + ": KITTI poses without a times.txt in the same folder cannot be flown"};
  }
  FlightLog log{poses->trajectory, poses->warnings};
  warn_of_gaps_in(*poses, path.string(), log.warnings);
  if (!camera_poses) return log;
  const Pose T_camera_body = Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()}.inverse();
  log.T_world_body = {};
  for (const StampedPose& stamped : poses->trajectory.poses()) {
    // Cannot fail: the stamps increase and the poses were checked.
    static_cast<void>(log.T_world_body.append({stamped.t_ns, stamped.pose * T_camera_body}));
  }
  return log;
}

}  // namespace overfly::flight
