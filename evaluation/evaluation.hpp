// Scores of an estimate against the truth. Pure functions of their arguments.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/estimate.hpp"
#include "core/result.hpp"
#include "core/trajectory.hpp"

namespace overfly::evaluation {

enum class Association {
  kInterpolate,  ///< truth at the estimate's stamp (default)
  kNearest,      ///< truth pose with the nearest stamp, within max_time_difference, as evo does
  kIndex,        ///< pose i to pose i, for files without times
};

enum class AlignmentMode { kNone, kOrigin, kInitScale, kSe3, kSim3, kYawOnly, kOriginSim3 };

/// "none", "origin", "init_scale", "se3", "sim3", "yaw_only", "origin_sim3".
[[nodiscard]] const char* to_string(AlignmentMode mode);
[[nodiscard]] std::optional<AlignmentMode> alignment_mode_from(const std::string& text);
[[nodiscard]] const std::vector<AlignmentMode>& all_alignment_modes();

/// How the run of an estimator went. Where several hold, the first of DIVERGED, RESET, LOST,
/// INIT_LATE is told. CRASHED and TIMEOUT are not seen in a track: who runs the estimator puts them
/// into Score::outcome.
///
/// COMPLETED: it started in time, tracks at the end of the flight, in one map, and at least 95 % of
/// the flight's frames after its start count as tracked. LOST: it does not track at the end, or
/// fewer count. Frames in which it says that it is lost do not count, nor do frames that it never
/// got (dropped, late, lost on their way) in a stretch of a second or more without a tracked one:
/// darkness and missing images are judged alike. A shorter stretch of frames that it never got,
/// between tracked ones or after the last, counts as tracked: it was not lost there.
/// INIT_LATE: its first tracked frame is later after the first frame of the flight than 10 s or a
/// tenth of the flight, whichever is less, but never less than 2 s.
enum class Outcome {
  kCompleted,
  kNotInitialised,
  kInitLate,
  kLost,
  kReset,
  kDiverged,
  kCrashed,
  kTimeout,
};
[[nodiscard]] const char* to_string(Outcome outcome);  ///< "COMPLETED", "NOT_INITIALISED", ...

/// A frame that the camera of a flight, or a data set, has; whether an estimator got it or not.
struct FlightFrame {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
};

struct Options {
  /// Every frame of the flight, in order: those that were dropped, late, lost on their way or never
  /// given are among them. Empty = those of the track.
  std::vector<FlightFrame> flight;
  Association association = Association::kInterpolate;
  std::int64_t max_time_difference_ns = 10'000'000;  ///< kNearest only
  /// True depth of the ground along the optical axis at the first tracked pose [m].
  std::optional<double> init_true_depth_m;
  /// Mount of the camera, for roll, pitch and yaw of the body.
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  std::vector<double> rpe_lengths_m{100, 200, 300, 400, 500, 600, 700, 800};
};

/// One truth-estimate pair, in time order.
struct MatchedPose {
  std::int64_t t_ns = 0;
  Pose T_world_camera;  ///< truth
  Pose T_vo_camera;     ///< estimate
  std::optional<double> scene_depth;
};

/// Root mean square, mean, median, maximum of one error.
struct ErrorStatistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double max = 0.0;
};

/// Errors of the pieces of one length (Geiger, Lenz, Urtasun 2012, the KITTI odometry benchmark):
/// from every tenth pose to the first that is farther along the truth's path.
struct RelativeError {
  double length_m = 0.0;
  int pairs = 0;
  double translation_percent = 0.0;         ///< RMS of position error / length
  double rotation_deg_per_100m = 0.0;       ///< RMS
  double translation_mean_percent = 0.0;    ///< the mean, as KITTI prints it
  double rotation_mean_deg_per_100m = 0.0;  ///< the mean, as KITTI prints it
};

struct AlignmentScore {
  AlignmentMode mode = AlignmentMode::kNone;
  Similarity S_world_vo;
  int matched = 0;
  ErrorStatistics position_m;
  /// Geodesic angle; empty, as the next, where the alignment is degenerate.
  std::optional<ErrorStatistics> rotation_deg;
  std::optional<ErrorStatistics> rotation_euler_norm_deg;
  /// Over all frames from the first tracked to the end of the flight, those without a pose taken at
  /// the last one before.
  double position_rmse_hold_m = 0.0;
  std::vector<RelativeError> relative;
  std::vector<std::string> notes;  ///< e.g. "scale from the path of the first 5 s"
  /// Why the positions do not determine the rotation; position errors hold all the same.
  std::optional<std::string> degenerate;
};

struct Score {
  Outcome outcome = Outcome::kNotInitialised;
  std::optional<double> outcome_time_s;  ///< of the late start, loss, reset or divergence
  int reset_count = 0;                   ///< since the first tracked frame
  double coverage = 0.0;                 ///< tracked frames / frames of the flight, [0, 1]
  std::optional<double> initialised_at_s;
  int frames = 0;  ///< of the flight
  int tracked_frames = 0;
  /// Per mode; a mode that the data cannot determine has its reason in `unavailable` instead.
  std::map<AlignmentMode, AlignmentScore> alignments;
  std::map<AlignmentMode, std::string> unavailable;
};

/// Pairs the tracked samples of the longest map with the truth.
/// Errors: kInvalidArgument when nothing overlaps, with both time ranges.
[[nodiscard]] Result<std::vector<MatchedPose>> associate(const Trajectory& T_world_camera_truth,
                                                         const EstimateTrack& estimate,
                                                         const Options& options);

/// What a reader of an alignment must know.
struct AlignmentRemarks {
  std::vector<std::string> notes;
  std::optional<std::string> degenerate;  ///< as AlignmentScore::degenerate
};

/// S_world_vo of one mode from matched poses:
/// none: as it is. origin: the first poses made equal, scale 1. init_scale: the same with the scale
/// init_true_depth_m / scene depth of the first pose, or, where one of them is absent, the ratio of
/// path lengths over the first 5 s (noted). se3, sim3: least squares over positions (Umeyama 1991).
/// yaw_only: the same with rotation about up only, scale 1 (Zhang, Scaramuzza 2018). origin_sim3:
/// sim3 with the first position held.
/// Near a straight line se3, sim3 and origin_sim3 are degenerate: positions do not determine the
/// rotation about it (see kStraightRatio in umeyama.hpp). On an exact line that rotation is taken
/// from the orientations (noted).
/// Errors: kInvalidArgument when the mode needs more than the data has (the message says what).
[[nodiscard]] Result<Similarity> align(const std::vector<MatchedPose>& matches,
                                       AlignmentMode mode,
                                       const Options& options,
                                       AlignmentRemarks* remarks = nullptr);

/// Scores an estimate against the truth: outcome, coverage and every alignment mode.
/// Frames of the flight: Options::flight.
[[nodiscard]] Score score(const Trajectory& T_world_camera_truth,
                          const EstimateTrack& estimate,
                          const Options& options);

}  // namespace overfly::evaluation
