#include "server/scoring/file_score.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "core/time.hpp"
#include "evaluation/long_steps.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server {
namespace {

using evaluation::AlignmentMode;
using Json = nlohmann::json;

/// A number given as a comment in a TUM file. Errors: kUnreadable naming file and value.
Result<std::optional<double>> comment_number(const NamedTrajectory& trajectory,
                                             const std::string& key) {
  const auto comment = trajectory.file.comments.find(key);
  if (comment == trajectory.file.comments.end()) return std::optional<double>();
  try {
    std::size_t used = 0;
    const double value = std::stod(comment->second, &used);
    const bool valid = used == comment->second.size() && std::isfinite(value) && value > 0.0;
    if (valid) return std::optional<double>(value);
  } catch (const std::exception&) {
    // Reported below, with all values that are not positive numbers.
  }
  return Error{
      ErrorCode::kUnreadable,
      trajectory.name + ": # " + key + " " + comment->second + ": must be a positive number"};
}

/// Errors: kInvalidArgument for a file whose i-th pose is not the one of its i-th line.
Status check_listed(const NamedTrajectory& trajectory) {
  if (trajectory.file.as_listed()) return {};
  return Error{ErrorCode::kInvalidArgument,
               trajectory.name +
                   ": contains unknown poses, repeated times or unsorted times, so that "
                   "its poses cannot be matched by number; add times to both files"};
}

std::string counted_poses(const NamedTrajectory& trajectory) {
  return trajectory.name + " (" + std::to_string(trajectory.file.trajectory.size()) + " poses)";
}

/// For files that are matched by number only because one has no times.
/// Errors: kInvalidArgument if their numbers of poses differ: the numbers then show no pairs.
Status check_same_count(const NamedTrajectory& truth, const NamedTrajectory& estimate) {
  if (truth.file.trajectory.size() == estimate.file.trajectory.size()) return {};
  const NamedTrajectory& without = truth.file.has_times ? estimate : truth;
  return Error{ErrorCode::kInvalidArgument,
               counted_poses(truth) + " and " + counted_poses(estimate) +
                   ": cannot be matched by number, because their numbers of poses differ, nor by "
                   "time, because " +
                   without.name +
                   " has none; add times, or use association index (--association index) if pose "
                   "i belongs to pose i"};
}

Result<evaluation::Options> options_for(const NamedTrajectory& truth,
                                        const NamedTrajectory& estimate,
                                        const FileScoreRequest& request) {
  evaluation::Options options;
  options.association = request.association;
  // Poses without times can be matched only by their number.
  options.has_times = truth.file.has_times;
  if (!truth.file.has_times || !estimate.file.has_times) {
    options.association = evaluation::Association::kIndex;
    if (request.association != evaluation::Association::kIndex) {
      if (Status same = check_same_count(truth, estimate); !same) return same.error();
    }
  }
  options.max_time_difference_ns = request.max_time_difference_ns;
  const auto depth = comment_number(estimate, "init_true_depth");
  if (!depth) return depth.error();
  options.init_true_depth_m = request.init_true_depth_m ? request.init_true_depth_m : *depth;
  if (options.association == evaluation::Association::kIndex) {
    Status listed = check_listed(truth);
    if (listed) listed = check_listed(estimate);
    if (!listed) return listed.error();
  }
  return options;
}

Result<EstimateTrack> track_from(const NamedTrajectory& estimate) {
  const auto depth = comment_number(estimate, "init_scene_depth");
  if (!depth) return depth.error();
  EstimateTrack track;
  track.name = estimate.name;
  track.samples.reserve(estimate.file.trajectory.size());
  for (const StampedPose& stamped : estimate.file.trajectory.poses()) {
    EstimateSample sample;
    sample.frame = static_cast<std::int64_t>(track.samples.size());
    sample.t_ns = stamped.t_ns;
    sample.state = TrackingState::kTracking;
    sample.T_vo_camera = stamped.pose;
    if (track.samples.empty()) sample.scene_depth = *depth;
    track.samples.push_back(sample);
  }
  return track;
}

/// The truth with its long steps as gaps, and what was found.
struct SplitTruth {
  evaluation::LongSteps steps;
  std::optional<Trajectory> with_gaps;  ///< empty if it has no long steps
};

SplitTruth split_truth(const Trajectory& truth) {
  SplitTruth split{evaluation::long_steps(truth), std::nullopt};
  if (!split.steps.ending.empty()) split.with_gaps = evaluation::with_gaps_in(split.steps, truth);
  return split;
}

/// Remarks on a truth and an estimate that were matched.
std::vector<std::string> warnings_of(const NamedTrajectory& truth,
                                     const NamedTrajectory& estimate,
                                     const SplitTruth& split,
                                     evaluation::Association association) {
  std::vector<std::string> warnings = estimate.file.warnings;
  const bool of_body = truth.file.format == TrajectoryFormat::kEuroc;
  if (of_body != (estimate.file.format == TrajectoryFormat::kEuroc)) {
    const NamedTrajectory& body = of_body ? truth : estimate;
    const NamedTrajectory& other = of_body ? estimate : truth;
    warnings.push_back(body.name +
                       ": files of the EuRoC format have the poses of the body, that "
                       "is, of the IMU: those of " +
                       other.name +
                       " must be of the body too, "
                       "because nothing is converted here (overfly track converts them)");
  }
  if (!split.with_gaps || association != evaluation::Association::kInterpolate) return warnings;
  const std::vector<StampedPose>& poses = estimate.file.trajectory.poses();
  const auto left_out = std::count_if(poses.begin(), poses.end(), [&](const StampedPose& pose) {
    return truth.file.trajectory.at(pose.t_ns) && !split.with_gaps->at(pose.t_ns);
  });
  if (left_out > 0) {
    warnings.push_back(std::to_string(left_out) + " poses of " + estimate.name +
                       " have no truth in " + truth.name + ": " +
                       evaluation::words_for(split.steps));
  }
  return warnings;
}

/// Keeps only the requested modes.
void choose_modes(const std::vector<AlignmentMode>& wanted, evaluation::Score& score) {
  const auto unwanted = [&](const auto& entry) {
    return std::find(wanted.begin(), wanted.end(), entry.first) == wanted.end();
  };
  std::erase_if(score.alignments, unwanted);
  std::erase_if(score.unavailable, unwanted);
}

double path_between_m(const std::vector<StampedPose>& poses,
                      std::int64_t begin_ns,
                      std::int64_t end_ns) {
  double path_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i - 1].t_ns < begin_ns || poses[i].t_ns > end_ns) continue;
    path_m += (poses[i].pose.translation - poses[i - 1].pose.translation).norm();
  }
  return path_m;
}

Json offsets_json(const evaluation::Offsets& offsets) {
  Json json = {{"clock", nullptr}, {"mount", nullptr}};
  if (const auto& clock = offsets.clock) {
    json["clock"] = {{"time_offset_s", s_from_ns(clock->offset_ns)},
                     {"position_rmse_before_m", clock->position_rmse_before_m},
                     {"position_rmse_after_m", clock->position_rmse_after_m},
                     {"explained", clock->explained}};
  }
  if (const auto& mount = offsets.mount) {
    const Eigen::Quaterniond& q = mount->R_estimated_true;
    const double angle_rad = rotation_angle_rad(q, Eigen::Quaterniond::Identity());
    json["mount"] = {{"angle_deg", deg_from_rad(angle_rad)},
                     {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}},
                     {"rotation_rmse_before_deg", mount->rotation_rmse_before_deg},
                     {"rotation_rmse_after_deg", mount->rotation_rmse_after_deg},
                     {"explained", mount->explained}};
  }
  return json;
}

}  // namespace

Result<FileScore> score_file(const NamedTrajectory& truth,
                             const NamedTrajectory& estimate,
                             const FileScoreRequest& request) {
  const Result<evaluation::Options> options = options_for(truth, estimate, request);
  if (!options) return options.error();
  const Result<EstimateTrack> track = track_from(estimate);
  if (!track) return track.error();
  // Nearest and numbered poses are there: nothing is interpolated.
  const bool interpolates =
      options->association == evaluation::Association::kInterpolate || request.find_offsets;
  const SplitTruth split = interpolates ? split_truth(truth.file.trajectory) : SplitTruth{};
  const Trajectory& true_poses = split.with_gaps ? *split.with_gaps : truth.file.trajectory;
  FileScore result;
  result.name = estimate.name;
  result.poses = track->samples.size();
  result.association = options->association;
  result.warnings = warnings_of(truth, estimate, split, options->association);
  // Called first, because its error explains why nothing could be matched.
  auto matches = evaluation::associate(true_poses, *track, *options);
  if (!matches) {
    Error error = matches.error().in(estimate.name);
    if (split.with_gaps) error.message += "; of the truth, " + evaluation::words_for(split.steps);
    return error;
  }
  result.matches = std::move(*matches);
  if (!result.matches.empty()) {
    result.truth_path_m =
        path_between_m(true_poses.poses(), result.matches.front().t_ns, result.matches.back().t_ns);
  }
  result.score = evaluation::score(true_poses, *track, *options);
  choose_modes(request.alignments, result.score);
  // Without times, poses count as 1 s apart: then a step of 1 cm gives the direction.
  const double least_speed_m_s = options->has_times ? evaluation::kLeastSpeed_m_s : 0.01;
  for (const auto& [mode, alignment] : result.score.alignments) {
    result.axis_errors[mode] = evaluation::axis_errors(
        true_poses, result.matches, alignment.S_world_vo, options->T_body_camera, least_speed_m_s);
  }
  if (request.find_offsets && options->association != evaluation::Association::kIndex) {
    result.offsets = evaluation::find_offsets(true_poses, *track);
  }
  return result;
}

Json json_from(const FileScore& score) {
  Json alignments = alignments_json(score.score);
  for (const auto& [mode, errors] : score.axis_errors) {
    const evaluation::AxisRmse rmse = evaluation::rmse_of(errors);
    Json& entry = alignments.at(evaluation::to_string(mode));
    entry["along_rmse_m"] = rmse.along_m;
    entry["across_rmse_m"] = rmse.across_m;
    entry["horizontal_rmse_m"] = rmse.horizontal_m;
    entry["vertical_rmse_m"] = rmse.vertical_m;
    const double position_m = score.score.alignments.at(mode).position_m.rmse;
    entry["percent_of_path"] =
        score.truth_path_m > 0.0 ? Json(100.0 * position_m / score.truth_path_m) : Json(nullptr);
  }
  const bool diverged = score.score.outcome == evaluation::Outcome::kDiverged;
  Json json = {
      {"poses", score.poses},
      {"matched", score.matches.size()},
      {"association", evaluation::to_string(score.association)},
      {"warnings", score.warnings},
      {"truth_path_m", score.truth_path_m},
      {"diverged_at_s",
       diverged && score.score.outcome_time_s ? Json(*score.score.outcome_time_s) : Json(nullptr)},
      {"alignments", std::move(alignments)},
      {"unavailable", unavailable_json(score.score)}};
  if (score.offsets) json["offsets"] = offsets_json(*score.offsets);
  return json;
}

}  // namespace overfly::server
