// Scores a trajectory file against another one that is the truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/trajectory_io.hpp"
#include "core/result.hpp"
#include "evaluation/axis_errors.hpp"
#include "evaluation/evaluation.hpp"
#include "evaluation/offsets.hpp"

namespace overfly::server {

struct FileScoreRequest {
  std::vector<evaluation::AlignmentMode> alignments;  ///< those that are wanted
  evaluation::Association association = evaluation::Association::kInterpolate;
  std::int64_t max_time_difference_ns = 10'000'000;  ///< kNearest only
  /// True depth along the optical axis at the first pose [m]; by default the comment
  /// init_true_depth of the estimate's file.
  std::optional<double> init_true_depth_m;
  bool find_offsets = false;  ///< of clock and mount; not where poses are matched by number
};

/// A trajectory file and its name in messages.
struct NamedTrajectory {
  std::string name;
  const TrajectoryFile& file;
};

/// The score of one file by the alignments that were asked for.
struct FileScore {
  std::string name;
  std::size_t poses = 0;
  evaluation::Association association = evaluation::Association::kInterpolate;  ///< as used
  std::vector<std::string> warnings;  ///< of reading the file, and of what the scores assume
  /// Length of the truth from the first match to the last; gaps count as straight lines.
  double truth_path_m = 0.0;
  std::vector<evaluation::MatchedPose> matches;
  evaluation::Score score;
  /// Position errors in the axes of the path, one for each match.
  std::map<evaluation::AlignmentMode, std::vector<evaluation::AxisError>> axis_errors;
  std::optional<evaluation::Offsets> offsets;  ///< if they were asked for
};

/// Poses without times are matched by number, whatever association is asked for. Long steps of the
/// truth (evaluation/long_steps.hpp) are gaps.
/// Errors: kUnreadable for a comment that is no positive number; kInvalidArgument if nothing can be
/// matched, and for poses that cannot be matched by number: among them those of files with
/// different numbers of poses, unless kIndex is asked for.
[[nodiscard]] Result<FileScore> score_file(const NamedTrajectory& truth,
                                           const NamedTrajectory& estimate,
                                           const FileScoreRequest& request);

/// {"poses", "matched", "association", "warnings", "alignments", "unavailable", ...}
/// (docs/PROTOCOL.md).
[[nodiscard]] nlohmann::json json_from(const FileScore& score);

}  // namespace overfly::server
