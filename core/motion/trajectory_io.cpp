#include "core/motion/trajectory_io.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/motion/pose_columns.hpp"
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
  const auto q = unit_quaternion(file, line, Eigen::Quaterniond(n[6], n[3], n[4], n[5]));
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
  const auto q = unit_quaternion(file, line, Eigen::Quaterniond(n[3], n[4], n[5], n[6]));
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

/// A file with named columns: the line of names is the first one.
Status read_csv(const fs::path& path, const FieldFile& file, TrajectoryFile* result) {
  const Result<PoseColumns> columns = PoseColumns::named_by(file, file.lines().front());
  if (!columns) return columns.error();
  std::vector<Row> rows;
  for (std::size_t i = 1; i < file.lines().size(); ++i) {
    const FieldLine& line = file.lines()[i];
    const Result<std::int64_t> t_ns = columns->time_of(file, line);
    if (!t_ns) return t_ns.error();
    if (columns->is_gap(line)) {
      rows.push_back({&line, {*t_ns, {}}, false});
      continue;
    }
    const Result<Pose> pose = columns->pose_of(file, line);
    if (!pose) return pose.error();
    rows.push_back({&line, {*t_ns, *pose}});
  }
  return take_rows(file, path.string(), rows, result);
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

/// Detects the format from the first line: names between commas mean CSV, numbers between commas
/// EuRoC, 12 columns KITTI, all else TUM.
TrajectoryFormat format_of(const FieldLine& first) {
  if (first.comma_separated) {
    return is_line_of_names(first) ? TrajectoryFormat::kCsv : TrajectoryFormat::kEuroc;
  }
  return first.fields.size() == 12 ? TrajectoryFormat::kKitti : TrajectoryFormat::kTum;
}

Status read_poses(const fs::path& path,
                  const FieldFile& file,
                  const FieldFile::Limits& limits,
                  TrajectoryFile* result) {
  switch (result->format) {
    case TrajectoryFormat::kKitti:
      return read_kitti(path, file, limits, result);
    case TrajectoryFormat::kCsv:
      return read_csv(path, file, result);
    case TrajectoryFormat::kTum:
    case TrajectoryFormat::kEuroc:
      break;
  }
  return read_rows(path, file, result);
}

/// Whether the first lines of a file are of this format. Errors: kUnreadable.
Status check_first_pose(const FieldFile& start, TrajectoryFormat format) {
  const FieldLine& first = start.lines().front();
  const auto status_of = [](const auto& result) { return result ? Status{} : result.error(); };
  switch (format) {
    case TrajectoryFormat::kKitti:
      return status_of(kitti_pose(start, first));
    case TrajectoryFormat::kCsv: {
      const Result<PoseColumns> columns = PoseColumns::named_by(start, first);
      if (!columns || start.lines().size() < 2) return status_of(columns);
      const FieldLine& second = start.lines()[1];
      if (Status status = status_of(columns->time_of(start, second)); !status) return status;
      return columns->is_gap(second) ? Status{} : status_of(columns->pose_of(start, second));
    }
    case TrajectoryFormat::kTum:
      return is_unknown(first) ? Status{} : status_of(tum_pose(start, first));
    case TrajectoryFormat::kEuroc:
      return status_of(euroc_pose(start, first));
  }
  return {};
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
  result.format = format_of(file->lines().front());
  const Status rows = read_poses(path, *file, limits, &result);
  if (!rows) return rows.error();
  if (result.trajectory.empty()) {
    const char* rest = result.unknown_poses > 0 ? ", only gaps" : "";
    return Error{ErrorCode::kUnreadable, path.string() + ": contains no poses" + rest};
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
    case TrajectoryFormat::kCsv:
      return "csv";
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
  const TrajectoryFormat format = format_of(first);
  if (Status status = check_first_pose(*start, format); !status) return status.error();
  return format;
}

}  // namespace overfly
