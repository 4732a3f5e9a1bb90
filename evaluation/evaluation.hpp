// Scores an estimate against the truth. Pure functions of their arguments.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/estimate.hpp"
#include "core/motion/trajectory.hpp"
#include "core/result.hpp"
#include "evaluation/consistency.hpp"
#include "evaluation/fix_drift.hpp"

namespace overfly::evaluation {

enum class Association {
  kInterpolate,  ///< truth at the estimate's stamp (default)
  kNearest,      ///< truth pose with the nearest stamp, within max_time_difference, as evo does
  kIndex,        ///< pose i to pose i, for files without times
};

/// "interpolate", "nearest", "index".
[[nodiscard]] const char* to_string(Association association);

enum class AlignmentMode {
  kNone,
  kOrigin,
  kInitScale,
  kSe3,
  kSim3,
  kYawOnly,
  kOriginSim3,
  kFirstSim3,
};

/// "none", "origin", "init_scale", "se3", "sim3", "yaw_only", "origin_sim3", "first_sim3".
[[nodiscard]] const char* to_string(AlignmentMode mode);
[[nodiscard]] std::optional<AlignmentMode> alignment_mode_from(const std::string& text);
[[nodiscard]] const std::vector<AlignmentMode>& all_alignment_modes();

/// Result of an estimator's run. If several conditions hold, the first of DIVERGED, RESET, LOST,
/// INIT_LATE is reported. CRASHED and TIMEOUT (it stopped answering) cannot be seen in a track: the
/// code that runs the estimator sets them in Score::outcome.
///
/// COMPLETED: the estimator initialised in time, tracks at the end of the flight in the same map,
/// and at least 95 % of the flight's frames after initialisation count as tracked.
/// LOST: it does not track at the end, or fewer frames count as tracked.
/// INIT_LATE: the time from the flight's first frame to the first tracked one exceeds the limit:
/// the smaller of 10 s and a tenth of the flight, but at least 2 s.
///
/// Frames reported as lost do not count as tracked. Frames that the estimator never received
/// (dropped, late, lost in transport) do not count if they belong to a stretch of a second or more
/// without a tracked frame: darkness and missing images are treated alike. Shorter stretches of
/// such frames count as tracked if they lie between tracked frames or after the last one.
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
[[nodiscard]] std::optional<Outcome> outcome_from(const std::string& text);

/// A frame of the flight's camera or of a data set, whether an estimator received it or not.
struct FlightFrame {
  std::int64_t frame = 0;
  std::int64_t t_ns = 0;
};

struct Options {
  /// Every frame of the flight, in order, including dropped and late frames and those lost in
  /// transport or never sent. If empty, the frames of the track are used.
  std::vector<FlightFrame> flight;
  Association association = Association::kInterpolate;
  std::int64_t max_time_difference_ns = 10'000'000;  ///< kNearest only
  /// True depth of the ground along the optical axis at the first tracked frame [m].
  std::optional<double> init_true_depth_m;
  /// Mount of the camera. Used to compute roll, pitch and yaw of the body.
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  /// KITTI's, and those between the position fixes of a long flight.
  std::vector<double> rpe_lengths_m{100, 200, 300, 400, 500, 600, 700, 800, 1000, 2000, 5000};
  std::vector<double> fix_intervals_m{1000, 2000, 5000};  ///< between position fixes
  /// AlignmentMode::kFirstSim3 is fitted to the poses of this time after the first matched one.
  double first_s = 10.0;
  double auc_limit_m = 10.0;  ///< largest threshold of AlignmentScore::position_auc, > 0
  /// False for files without times, whose poses count as 1 s apart: nothing is then concluded from
  /// times.
  bool has_times = true;
};

/// One truth-estimate pair, in time order.
struct MatchedPose {
  std::int64_t t_ns = 0;
  Pose T_world_camera;  ///< truth
  Pose T_vo_camera;     ///< estimate
  /// Of the first pair: that of the map's first tracked frame, which may be an earlier one without
  /// truth, because Options::init_true_depth_m belongs to that frame.
  std::optional<double> scene_depth;
  PoseCovariancePtr covariance = nullptr;  ///< of T_vo_camera's error; null if not stated
  /// After a gap of more than a second in the estimate: how much longer the true path since the
  /// previous match is than the straight line [m].
  double detour_m = 0.0;
};

/// Root mean square, mean, median and maximum of an error.
struct ErrorStatistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double max = 0.0;
};

/// Errors over segments of one length (Geiger, Lenz, Urtasun 2012, the KITTI odometry benchmark). A
/// segment goes from every tenth pose to the first pose farther away along the truth's path.
struct RelativeError {
  double length_m = 0.0;
  int pairs = 0;
  double translation_percent = 0.0;         ///< RMS of position error / length
  double rotation_deg_per_100m = 0.0;       ///< RMS of rotation error
  double translation_mean_percent = 0.0;    ///< the mean, as KITTI reports it
  double rotation_mean_deg_per_100m = 0.0;  ///< the mean, as KITTI reports it
};

struct AlignmentScore {
  AlignmentMode mode = AlignmentMode::kNone;
  Similarity S_world_vo;
  int matched = 0;
  /// Error of each matched pose; Score::matched_t_ns has their stamps. Only in scores from score(),
  /// not in those read from a file.
  std::vector<double> position_errors_m;
  std::vector<double> rotation_errors_deg;  ///< geodesic angle; empty if degenerate
  ErrorStatistics position_m;
  /// Root mean squares of its horizontal and vertical parts: the sum of their squares is that of
  /// position_m.rmse. Empty in scores of files that do not have them.
  std::optional<double> horizontal_rmse_m;
  std::optional<double> vertical_rmse_m;
  /// Geodesic angle. This and the next field are empty if the alignment is degenerate.
  std::optional<ErrorStatistics> rotation_deg;
  std::optional<ErrorStatistics> rotation_euler_norm_deg;
  /// Over all frames from the first tracked one to the end of the flight. A frame without a pose
  /// uses the last pose before it.
  double position_rmse_hold_m = 0.0;
  /// Area under the curve of the share of the flight's frames whose position error is below a
  /// threshold of 0 to Options::auc_limit_m, over that limit, [0, 1] (area_under_curve() in
  /// errors.hpp). Frames without a scored pose count as errors above the limit. Empty if
  /// Options::flight is empty, because a file with fewer poses would then score better, and in
  /// scores of earlier versions.
  std::optional<double> position_auc;
  std::vector<RelativeError> relative;
  std::vector<FixDrift> fix_drift;         ///< one for each of Options::fix_intervals_m
  std::optional<Consistency> consistency;  ///< if a scored pose has a covariance
  std::vector<std::string> notes;          ///< e.g. "scale from the path of the first 5 s"
  /// Why the positions do not determine the rotation. Position errors remain valid; those of
  /// first_sim3 then depend on the orientations at the start.
  std::optional<std::string> degenerate;
};

struct Score {
  Outcome outcome = Outcome::kNotInitialised;
  std::optional<double> outcome_time_s;  ///< of late initialisation, loss, reset or divergence
  /// True path flown until then; empty without truth, and in scores of earlier versions.
  std::optional<double> outcome_distance_m;
  /// How often it tracked again in a map in which it had tracked before, after a second or longer
  /// without a tracked frame: reported as lost, or never received. The first tracked frame of a new
  /// map is a reset instead. Empty in scores of earlier versions.
  std::optional<int> relocalisations;
  std::optional<double> relocalised_at_s;  ///< flight time of the first one
  int reset_count = 0;                     ///< further maps, from the first tracked frame on
  double coverage = 0.0;                   ///< tracked frames / frames of the flight, [0, 1]
  std::optional<double> initialised_at_s;
  int frames = 0;  ///< frames of the flight
  int tracked_frames = 0;
  /// Options::auc_limit_m of the alignments' position_auc; empty where they have none, but not in
  /// that of a flight without a scored pose, whose area is 0 by every alignment.
  std::optional<double> position_auc_limit_m;
  CovarianceCounts covariances;
  std::vector<std::int64_t> matched_t_ns;  ///< stamps of the matched poses, in time order
  /// Results by mode. If the data cannot determine a mode, `unavailable` has the reason instead.
  std::map<AlignmentMode, AlignmentScore> alignments;
  std::map<AlignmentMode, std::string> unavailable;
};

/// Sets the time of the outcome and the distance flown until then.
void set_outcome_time(const Trajectory& T_world_camera_truth, double t_s, Score* score);

/// Matches the tracked samples of the longest map with the truth.
/// Errors: kInvalidArgument with both time ranges if nothing overlaps.
[[nodiscard]] Result<std::vector<MatchedPose>> associate(const Trajectory& T_world_camera_truth,
                                                         const EstimateTrack& estimate,
                                                         const Options& options);

/// Remarks on an alignment.
struct AlignmentRemarks {
  std::vector<std::string> notes;
  std::optional<std::string> degenerate;  ///< as AlignmentScore::degenerate
};

/// Computes S_world_vo of one mode from matched poses.
/// - none: identity.
/// - origin: aligns the first poses; scale 1.
/// - init_scale: as origin, with the scale init_true_depth_m / scene depth of the first frame. If
/// one of the two is absent, the ratio of path lengths over the first 5 s is used and noted;
/// without times, over the first 50 steps, which are 5 s at the 10 Hz of the KITTI benchmark.
/// - se3, sim3: least squares over positions (Umeyama 1991).
/// - yaw_only: least squares with rotation about the vertical only, scale 1 (Zhang, Scaramuzza
/// 2018).
/// - origin_sim3: sim3 with the first position fixed.
/// - first_sim3: sim3 fitted to the poses of the first Options::first_s only, so that the errors
/// after them show the drift; without times, to the first 100 poses, which are 10 s at 10 Hz. The
/// number of poses and their time are noted.
///
/// Near a straight line se3, sim3, origin_sim3 and first_sim3 are degenerate: positions do not
/// determine the rotation about the line (see kStraightRatio in umeyama.hpp). On an exact line, and
/// for first_sim3 also near one, that rotation is taken from the orientations and noted.
/// Errors: kInvalidArgument if the data is not sufficient for the mode; the message says what is
/// missing.
[[nodiscard]] Result<Similarity> align(const std::vector<MatchedPose>& matches,
                                       AlignmentMode mode,
                                       const Options& options,
                                       AlignmentRemarks* remarks = nullptr);

/// Share of the flight's frames, from the first tracked one on, that count as tracked for the
/// outcome: a short stretch of frames that the estimator never received counts if tracking goes on
/// in the same map. 0 without a tracked frame. Outcome LOST is one below 0.95.
[[nodiscard]] double kept_share(const EstimateTrack& estimate, const Options& options);

/// Largest ratio of the estimate's scales in two windows of 10 s, at least 1; infinite if it stood
/// still in one of them only. Empty if the matches have no such window. Outcome DIVERGED is one
/// above 2.
[[nodiscard]] std::optional<double> scale_change(const std::vector<MatchedPose>& matches);

/// Scores an estimate against the truth: outcome, coverage and every alignment mode.
/// Options::flight defines the frames of the flight.
[[nodiscard]] Score score(const Trajectory& T_world_camera_truth,
                          const EstimateTrack& estimate,
                          const Options& options);

}  // namespace overfly::evaluation
