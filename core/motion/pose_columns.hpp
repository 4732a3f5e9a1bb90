// Poses in a table whose columns are named.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "core/text/text_fields.hpp"

namespace overfly {

/// Whether a line consists of names: its first field is no number.
[[nodiscard]] bool is_line_of_names(const FieldLine& line);

/// Checks that a quaternion has unit norm within the rounding of printed decimals.
/// Errors: kUnreadable.
[[nodiscard]] Result<Eigen::Quaterniond> unit_quaternion(const FieldFile& file,
                                                         const FieldLine& line,
                                                         const Eigen::Quaterniond& q);

/// Which columns hold time, position and rotation. Names may have capitals, quotes, `_`, `.` and
/// blanks, and a unit: `t_ns`, `x [m]`, `Time (s)`.
/// - Time: t, time, stamp, timestamp, sec, seconds; in s unless the name has s, ms, us or ns. The
///   first of them counts.
/// - Position [m]: x y z, alone or after t, p, pos, position, pose.position, p_RS_R,
///   p_world_camera; or east north up.
/// - Rotation: x y z w after q, quat, quaternion, rotation, orientation, pose.orientation, q_RS,
///   q_world_camera.
/// Other columns are ignored. Angles are not read: their order and axes differ between programs.
class PoseColumns {
 public:
  /// Errors: kUnreadable naming what is missing or there twice.
  static Result<PoseColumns> named_by(const FieldFile& file, const FieldLine& names);

  /// Errors: kUnreadable.
  [[nodiscard]] Result<std::int64_t> time_of(const FieldFile& file, const FieldLine& line) const;
  /// Whether no value of the pose is there: each field is empty, `nan` or `null`.
  [[nodiscard]] bool is_gap(const FieldLine& line) const;
  /// Errors: kUnreadable naming line, column and value.
  [[nodiscard]] Result<Pose> pose_of(const FieldFile& file, const FieldLine& line) const;

 private:
  std::size_t time_ = 0;  // columns count from 1; 0 = not found
  TimeUnit unit_ = TimeUnit::kSeconds;
  std::array<std::size_t, 7> pose_{};  // x y z, qx qy qz qw
  std::size_t fields_ = 0;             // of the line of names
};

}  // namespace overfly
