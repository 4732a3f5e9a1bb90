#include "core/trajectory_io.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/text_fields.hpp"
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

/// A quaternion that is a rotation but for the rounding of its printing.
Result<Eigen::Quaterniond> rotation_from(const FieldFile& file,
                                         const FieldLine& line,
                                         const Eigen::Quaterniond& q) {
  constexpr double kNormTolerance = 0.01;  // three printed decimals stay within 0.001
  if (std::abs(q.norm() - 1.0) > kNormTolerance) {
    return file.bad_line(
        line, "the quaternion's length is " + std::to_string(q.norm()) + ": must be 1 within 0.01");
  }
  return q;
}

Status append(const FieldFile& file,
              const FieldLine& line,
              Trajectory* trajectory,
              const StampedPose& stamped) {
  if (!trajectory->empty() && stamped.t_ns <= trajectory->end_ns()) {
    return file.bad_field(line, 1, "must be after the time of the pose before");
  }
  if (Status status = trajectory->append(stamped); !status) {
    return file.bad_line(line, status.error().message);
  }
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

/// TUM monoVO's truth says so where the motion capture did not see the camera.
bool is_unknown(const FieldLine& line) {
  return line.fields.size() == 8 &&
         std::all_of(line.fields.begin() + 1, line.fields.end(), [](std::string_view field) {
           return field == "nan" || field == "NaN";
         });
}

/// EuRoC ASL ground truth: t [ns], p_xyz, q_wxyz, and columns that we do not need.
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

/// KITTI: the upper 3 x 4 of T_world_camera, row-major. The stamp is left to the caller.
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

/// The stamps of `times.txt` beside a KITTI file; empty where there are none of as many lines.
Result<std::vector<std::int64_t>> kitti_times(const fs::path& poses_file, std::size_t count) {
  const fs::path times_file = poses_file.parent_path() / "times.txt";
  std::vector<std::int64_t> times;
  if (times_file == poses_file || !fs::exists(times_file)) return times;
  const Result<FieldFile> file = FieldFile::read(times_file);
  if (!file) return file.error();
  if (file->lines().size() != count) return times;
  for (const FieldLine& line : file->lines()) {
    if (Status status = file->expect_fields(line, 1); !status) return status.error();
    const Result<std::int64_t> t_ns = file->time_s(line, 1);
    if (!t_ns) return t_ns.error();
    if (!times.empty() && *t_ns <= times.back()) {
      return file->bad_field(line, 1, "must be after the time before");
    }
    times.push_back(*t_ns);
  }
  return times;
}

Status read_kitti(const fs::path& path, const FieldFile& file, TrajectoryFile* result) {
  const Result<std::vector<std::int64_t>> times = kitti_times(path, file.lines().size());
  if (!times) return times.error();
  result->has_times = !times->empty();
  std::size_t i = 0;
  for (const FieldLine& line : file.lines()) {
    const Result<Pose> pose = kitti_pose(file, line);
    if (!pose) return pose.error();
    const std::int64_t t_ns =
        result->has_times ? (*times)[i] : static_cast<std::int64_t>(i) * kNsPerS;
    ++i;
    if (Status status = append(file, line, &result->trajectory, {t_ns, *pose}); !status) {
      return status;
    }
  }
  return {};
}

/// Told by the first line: commas are EuRoC's, 12 columns KITTI's, all else is taken for TUM.
TrajectoryFormat format_of(const FieldFile& file, bool comma_separated) {
  if (comma_separated) return TrajectoryFormat::kEuroc;
  return file.lines().front().fields.size() == 12 ? TrajectoryFormat::kKitti
                                                  : TrajectoryFormat::kTum;
}

}  // namespace

Result<TrajectoryFile> read_trajectory(const fs::path& path) {
  const Result<FieldFile> file = FieldFile::read(path);
  if (!file) return file.error();
  if (file->lines().empty()) {
    return Error{ErrorCode::kUnreadable, path.string() + ": holds no pose"};
  }
  TrajectoryFile result;
  result.comments = file->comments();
  result.format = format_of(*file, file->lines().front().comma_separated);
  if (result.format == TrajectoryFormat::kKitti) {
    if (Status status = read_kitti(path, *file, &result); !status) return status.error();
    return result;
  }
  for (const FieldLine& line : file->lines()) {
    if (result.format == TrajectoryFormat::kTum && is_unknown(line)) {
      result.trajectory.append_gap();
      ++result.unknown_poses;
      continue;
    }
    const Result<StampedPose> stamped =
        result.format == TrajectoryFormat::kTum ? tum_pose(*file, line) : euroc_pose(*file, line);
    if (!stamped) return stamped.error();
    if (Status status = append(*file, line, &result.trajectory, *stamped); !status) {
      return status.error();
    }
  }
  if (result.trajectory.empty()) {
    return Error{ErrorCode::kUnreadable, path.string() + ": holds no pose but `nan`"};
  }
  return result;
}

}  // namespace overfly
