#include "core/motion/trajectory_io.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/motion/time_order.hpp"
#include "core/text/text_fields.hpp"
#include "core/time.hpp"

namespace overfly {
namespace {

namespace fs = std::filesystem;

/// The numbers of columns [first, first + count).
Result<std::vector<double>> numbers(const FieldFile& file,
                                    const FieldLine& line,
                                    std::size_t first,
                                    std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Result<double> value = file.number(line, first + i);
    if (!value) return value.error();
    values[i] = *value;
  }
  return values;
}

/// Checks that a quaternion has unit norm within the rounding of printed decimals.
Result<Eigen::Quaterniond> rotation_from(const FieldFile& file,
                                         const FieldLine& line,
                                         const Eigen::Quaterniond& q) {
  constexpr double kNormTolerance = 0.01;  // three printed decimals stay within 0.001
  if (std::abs(q.norm() - 1.0) > kNormTolerance) {
    return file.bad_line(
        line, "the quaternion's norm is " + std::to_string(q.norm()) + ": must be 1 within 0.01");
  }
  return q;
}

/// One line of a file: a pose, or a time at which the pose is unknown.
struct Row {
  const FieldLine* line = nullptr;
  StampedPose stamped;
  bool known = true;
};

/// Appends the rows to the trajectory in time order.
Status take_rows(const FieldFile& file,
                 const std::string& name,
                 const std::vector<Row>& rows,
                 TrajectoryFile* result) {
  std::vector<TimedLine> times;
  times.reserve(rows.size());
  for (const Row& row : rows) times.push_back({row.stamped.t_ns, row.line->number});
  TimeOrder order = order_by_time(name, "poses", times);
  for (const std::size_t i : order.kept) {
    const Row& row = rows[i];
    if (!row.known) {
      result->trajectory.append_gap();
      ++result->unknown_poses;
      continue;
    }
    if (Status status = result->trajectory.append(row.stamped); !status) {
      return file.bad_line(*row.line, status.error().message);
    }
  }
  result->warnings = std::move(order.warnings);
  return {};
}

Result<StampedPose> tum_pose(const FieldFile& file, const FieldLine& line) {
  if (Status status = file.expect_fields(line, 8); !status) return status.error();
  const Result<std::int64_t> t_ns = file.time_s(line, 1);
  if (!t_ns) return t_ns.error();
  const Result<std::vector<double>> v = numbers(file, line, 2, 7);
  if (!v) return v.error();
  const auto& n = *v;
  const auto q = rotation_from(file, line, Eigen::Quaterniond(n[6], n[3], n[4], n[5]));
  if (!q) return q.error();
  return StampedPose{*t_ns, {*q, {n[0], n[1], n[2]}}};
}

/// The truth of TUM monoVO has `nan` where the motion capture did not see the camera.
bool is_unknown(const FieldLine& line) {
  return line.fields.size() == 8 &&
         std::all_of(line.fields.begin() + 1, line.fields.end(), [](std::string_view field) {
           return field == "nan" || field == "NaN";
         });
}

/// EuRoC ASL ground truth: t [ns], p_xyz, q_wxyz; further columns are ignored.
Result<StampedPose> euroc_pose(const FieldFile& file, const FieldLine& line) {
  if (line.fields.size() < 8) {
    return file.bad_line(line, std::to_string(line.fields.size()) + " columns: must be 8 or more");
  }
  const Result<std::int64_t> t_ns = file.time_ns(line, 1);
  if (!t_ns) return t_ns.error();
  const Result<std::vector<double>> v = numbers(file, line, 2, 7);
  if (!v) return v.error();
  const auto& n = *v;
  const auto q = rotation_from(file, line, Eigen::Quaterniond(n[3], n[4], n[5], n[6]));
  if (!q) return q.error();
  return StampedPose{*t_ns, {*q, {n[0], n[1], n[2]}}};
}

/// KITTI: the upper 3 x 4 of T_world_camera, row-major. The caller sets the stamp.
Result<Pose> kitti_pose(const FieldFile& file, const FieldLine& line) {
  if (Status status = file.expect_fields(line, 12); !status) return status.error();
  const Result<std::vector<double>> v = numbers(file, line, 1, 12);
  if (!v) return v.error();
  const auto& n = *v;
  Eigen::Matrix3d R;
  R << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).norm();
  if (off > 1e-2 || R.determinant() < 0.0) {
    return file.bad_line(line, "columns 1-3, 5-7, 9-11 are not a rotation matrix");
  }
  return Pose{Eigen::Quaterniond(R).normalized(), {n[3], n[7], n[11]}};
}

/// The times file of a KITTI file, with one line for each pose.
struct KittiTimes {
  std::string name;
  FieldFile file;
  std::vector<std::int64_t> t_ns;
};

/// `times.txt` in the folder of a KITTI file; empty if it is absent or has another number of lines.
Result<std::optional<KittiTimes>> kitti_times(const fs::path& poses_file,
                                              std::size_t count,
                                              const FieldFile::Limits& limits) {
  const fs::path times_file = poses_file.parent_path() / "times.txt";
  std::error_code unknown;  // a file that cannot be accessed counts as absent
  if (times_file == poses_file || !fs::exists(times_file, unknown)) {
    return std::optional<KittiTimes>();
  }
  const Result<FieldFile> file = FieldFile::read(times_file, nullptr, limits);
  if (!file) return file.error();
  if (file->lines().size() != count) return std::optional<KittiTimes>();
  KittiTimes times{times_file.string(), *file, {}};
  for (const FieldLine& line : file->lines()) {
    if (Status status = file->expect_fields(line, 1); !status) return status.error();
    const Result<std::int64_t> t_ns = file->time_s(line, 1);
    if (!t_ns) return t_ns.error();
    times.t_ns.push_back(*t_ns);
  }
  return std::optional<KittiTimes>(std::move(times));
}

Status read_kitti(const fs::path& path,
                  const FieldFile& file,
                  const FieldFile::Limits& limits,
                  TrajectoryFile* result) {
  const Result<std::optional<KittiTimes>> times = kitti_times(path, file.lines().size(), limits);
  if (!times) return times.error();
  result->has_times = times->has_value();
  std::vector<Row> rows;
  for (std::size_t i = 0; i < file.lines().size(); ++i) {
    const Result<Pose> pose = kitti_pose(file, file.lines()[i]);
    if (!pose) return pose.error();
    const std::int64_t t_ns =
        result->has_times ? (*times)->t_ns[i] : static_cast<std::int64_t>(i) * kNsPerS;
    const FieldFile& stamped_in = result->has_times ? (*times)->file : file;
    rows.push_back({&stamped_in.lines()[i], {t_ns, *pose}});
  }
  const std::string name = result->has_times ? (*times)->name : path.string();
  return take_rows(file, name, rows, result);
}

Status read_rows(const fs::path& path, const FieldFile& file, TrajectoryFile* result) {
  std::vector<Row> rows;
  for (const FieldLine& line : file.lines()) {
    if (result->format == TrajectoryFormat::kTum && is_unknown(line)) {
      const Result<std::int64_t> t_ns = file.time_s(line, 1);
      if (!t_ns) return t_ns.error();
      rows.push_back({&line, {*t_ns, {}}, false});
      continue;
    }
    const Result<StampedPose> stamped =
        result->format == TrajectoryFormat::kTum ? tum_pose(file, line) : euroc_pose(file, line);
    if (!stamped) return stamped.error();
    rows.push_back({&line, *stamped});
  }
  return take_rows(file, path.string(), rows, result);
}

/// Detects the format from the first line: commas mean EuRoC, 12 columns KITTI, all else TUM.
TrajectoryFormat format_of(const FieldFile& file, bool comma_separated) {
  if (comma_separated) return TrajectoryFormat::kEuroc;
  return file.lines().front().fields.size() == 12 ? TrajectoryFormat::kKitti
                                                  : TrajectoryFormat::kTum;
}

Result<TrajectoryFile> read_with(const fs::path& path,
                                 const FieldFile::Limits& limits,
                                 const std::atomic<bool>* cancel) {
  const Result<FieldFile> file = FieldFile::read(path, cancel, limits);
  if (!file) return file.error();
  if (file->lines().empty()) {
    return Error{ErrorCode::kUnreadable, path.string() + ": contains no poses"};
  }
  TrajectoryFile result;
  result.comments = file->comments();
  result.format = format_of(*file, file->lines().front().comma_separated);
  const Status rows = result.format == TrajectoryFormat::kKitti
                          ? read_kitti(path, *file, limits, &result)
                          : read_rows(path, *file, &result);
  if (!rows) return rows.error();
  if (result.trajectory.empty()) {
    return Error{ErrorCode::kUnreadable, path.string() + ": contains no poses, only `nan`"};
  }
  return result;
}

}  // namespace

const char* to_string(TrajectoryFormat format) {
  switch (format) {
    case TrajectoryFormat::kTum:
      return "tum";
    case TrajectoryFormat::kKitti:
      return "kitti";
    case TrajectoryFormat::kEuroc:
      return "euroc";
  }
  return "";
}

Result<TrajectoryFile> read_trajectory(const fs::path& path, const std::atomic<bool>* cancel) {
  return read_with(path, {}, cancel);
}

Result<TrajectoryFile> read_trajectory(const fs::path& path,
                                       const TrajectoryLimits& limits,
                                       const std::atomic<bool>* cancel) {
  return read_with(path, {limits.max_bytes, limits.max_poses}, cancel);
}

Result<TrajectoryFormat> detect_trajectory(const fs::path& path) {
  constexpr std::size_t kStartBytes = std::size_t{64} << 10U;
  const Result<FieldFile> start = FieldFile::read_start(path, kStartBytes);
  if (!start) return start.error();
  if (start->lines().empty()) {
    return Error{ErrorCode::kUnreadable, path.string() + ": contains no poses"};
  }
  const FieldLine& first = start->lines().front();
  const TrajectoryFormat format = format_of(*start, first.comma_separated);
  if (format == TrajectoryFormat::kKitti) {
    const Result<Pose> pose = kitti_pose(*start, first);
    if (!pose) return pose.error();
    return format;
  }
  if (format == TrajectoryFormat::kTum && is_unknown(first)) return format;
  const Result<StampedPose> pose =
      format == TrajectoryFormat::kTum ? tum_pose(*start, first) : euroc_pose(*start, first);
  if (!pose) return pose.error();
  return format;
}

}  // namespace overfly
