// Reads TUM, KITTI, EuRoC ASL and CSV trajectory files and writes TUM files.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/motion/trajectory.hpp"
#include "core/result.hpp"

namespace overfly {

enum class TrajectoryFormat { kTum, kKitti, kEuroc, kCsv };
[[nodiscard]] const char* to_string(TrajectoryFormat format);  ///< "tum", "kitti", "euroc", "csv"

/// The content of a trajectory file.
struct TrajectoryFile {
  Trajectory trajectory;
  TrajectoryFormat format = TrajectoryFormat::kTum;
  /// False for KITTI poses without a times file; each stamp is then the line number in seconds.
  bool has_times = true;
  std::size_t unknown_poses = 0;  ///< rows of a TUM or CSV file without a pose: gaps
  /// `# key value` comments of a TUM file, e.g. init_scene_depth.
  std::map<std::string, std::string> comments;
  /// Poses that were dropped or moved, see order_by_time. Empty if none.
  std::vector<std::string> warnings;

  /// Whether pose i is the i-th of the file, as needed for matching by index.
  [[nodiscard]] bool as_listed() const { return warnings.empty() && unknown_poses == 0; }
};

/// Reads a trajectory and detects its format from the content.
/// TUM: `t tx ty tz qx qy qz qw` [s, m], with seven `nan` where the pose is unknown.
/// KITTI: 12 numbers, row-major 3 x 4; times from `times.txt` in the same folder if it exists and
/// has as many lines.
/// EuRoC: csv `t[ns], p_xyz, q_wxyz, ...`.
/// CSV: a line of names first, as PoseColumns.
/// Poses are sorted by time, and of several with the same time the first is kept; `warnings`
/// reports how many were moved or dropped.
/// @param cancel  stops reading; may be null
/// Errors: as FieldFile::read; kUnreadable naming file, line, column and value.
[[nodiscard]] Result<TrajectoryFile> read_trajectory(const std::filesystem::path& file,
                                                     const std::atomic<bool>* cancel = nullptr);

/// Limits of a file, and of the times file of a KITTI file.
struct TrajectoryLimits {
  std::uint64_t max_bytes = 0;
  std::size_t max_poses = 0;
};
/// As above, for files whose size others choose.
[[nodiscard]] Result<TrajectoryFile> read_trajectory(const std::filesystem::path& file,
                                                     const TrajectoryLimits& limits,
                                                     const std::atomic<bool>* cancel);

/// Detects the format from the first pose of a file, which is read no further than 64 KiB.
/// Errors: as ForwardReader::open; kUnreadable naming file and line, if the first line that is no
/// comment is no pose.
[[nodiscard]] Result<TrajectoryFormat> detect_trajectory(const std::filesystem::path& file);

/// The text of a TUM file. Stamps are exact to the nanosecond, and numbers read back exactly.
/// @pre comments have keys without spaces and values on one line
[[nodiscard]] std::string tum_text(const Trajectory& trajectory,
                                   const std::map<std::string, std::string>& comments = {});
/// Writes a TUM file, completely or not at all. Errors: kIo.
[[nodiscard]] Status write_tum(const std::filesystem::path& file,
                               const Trajectory& trajectory,
                               const std::map<std::string, std::string>& comments = {});

}  // namespace overfly
