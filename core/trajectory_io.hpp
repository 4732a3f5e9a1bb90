// Trajectory files: TUM, KITTI and EuRoC ASL in, TUM out.
#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "core/trajectory.hpp"

namespace overfly {

enum class TrajectoryFormat { kTum, kKitti, kEuroc };

/// A trajectory as it stood in a file.
struct TrajectoryFile {
  Trajectory trajectory;
  TrajectoryFormat format = TrajectoryFormat::kTum;
  /// False for KITTI poses without a times file: stamps are then the line's number in seconds.
  bool has_times = true;
  std::size_t unknown_poses = 0;  ///< rows of a TUM file whose pose is `nan`: gaps
  /// `# key value` comments of a TUM file, e.g. init_scene_depth.
  std::map<std::string, std::string> comments;
  /// Poses that were left out or moved, see order_by_time; empty where none was.
  std::vector<std::string> warnings;

  /// Whether pose i is the file's i-th, as matching by number needs.
  [[nodiscard]] bool as_listed() const { return warnings.empty() && unknown_poses == 0; }
};

/// Reads a trajectory, its format told by its content. TUM: `t tx ty tz qx qy qz qw` [s, m],
/// seven `nan` where the pose is not known;
/// KITTI: 12 numbers, row-major 3 x 4, with the times of `times.txt` beside it where there is one
/// of as many lines; EuRoC: csv `t[ns], p_xyz, q_wxyz, ...`.
/// Poses that are not in order of time are sorted, and of those with the same time the first is
/// kept; `warnings` counts them.
/// @param cancel  ends reading early; may be null
/// Errors: as FieldFile::read; kUnreadable naming file, line, column and value.
[[nodiscard]] Result<TrajectoryFile> read_trajectory(const std::filesystem::path& file,
                                                     const std::atomic<bool>* cancel = nullptr);

/// Writes TUM, stamps to the nanosecond and numbers that read back exactly.
/// The file appears whole or not at all. Errors: kIo.
[[nodiscard]] Status write_tum(const std::filesystem::path& file,
                               const Trajectory& trajectory,
                               const std::map<std::string, std::string>& comments = {});

}  // namespace overfly
