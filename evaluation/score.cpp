#include <utility>

#include "core/time.hpp"
#include "evaluation/association.hpp"
#include "evaluation/errors.hpp"
#include "evaluation/evaluation.hpp"
#include "evaluation/outcome.hpp"

namespace overfly::evaluation {
namespace {

/// A frame at or after the first tracked one, with the last known estimate.
struct HeldPose {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< truth
  Eigen::Vector3d p_vo = Eigen::Vector3d::Zero();     ///< tracked, or the last tracked before
};

std::vector<HeldPose> held_poses(const Trajectory& truth,
                                 const std::vector<FlownFrame>& flown,
                                 std::optional<int> map_id,
                                 const Options& options) {
  std::vector<HeldPose> held;
  std::optional<Eigen::Vector3d> last;
  for (const FlownFrame& frame : flown) {
    const EstimateSample& sample = frame.sample;
    if (frame.given && sample.state == TrackingState::kTracking && sample.map_id == map_id) {
      last = sample.T_vo_camera.translation;
    }
    if (!last) continue;
    if (const auto true_frame = truth_of(truth, sample, options)) {
      held.push_back({true_frame->T_world_camera.translation, *last});
    }
  }
  return held;
}

double hold_rmse_m(const std::vector<HeldPose>& held, const Similarity& S_world_vo) {
  std::vector<double> errors;
  errors.reserve(held.size());
  for (const HeldPose& pose : held)
    errors.push_back((S_world_vo * pose.p_vo - pose.p_world).norm());
  return errors.empty() ? 0.0 : rms(errors);
}

/// Notes that apply to all alignment modes.
std::vector<std::string> common_notes(const Score& score,
                                      const std::vector<MatchedPose>& matches,
                                      const EstimateTrack& estimate) {
  int map_frames = 0;
  const std::optional<int> map_id = longest_map(estimate);
  for (const EstimateSample& sample : estimate.samples) {
    if (sample.state == TrackingState::kTracking && sample.map_id == map_id) ++map_frames;
  }
  std::vector<std::string> notes;
  if (map_frames < score.tracked_frames) {
    notes.push_back("only the map with the most frames is scored: " + std::to_string(map_frames) +
                    " of " + std::to_string(score.tracked_frames) + " tracked frames, from " +
                    std::to_string(s_from_ns(matches.front().t_ns)) + " s to " +
                    std::to_string(s_from_ns(matches.back().t_ns)) + " s");
  }
  const int without_truth = map_frames - static_cast<int>(matches.size());
  if (without_truth > 0) {
    notes.push_back(std::to_string(without_truth) + " tracked frames have no truth");
  }
  return notes;
}

CovarianceCounts covariances_of(const EstimateTrack& estimate) {
  CovarianceCounts counts;
  for (const EstimateSample& sample : estimate.samples) {
    if (sample.state != TrackingState::kTracking) continue;
    if (sample.covariance) ++counts.stated;
    if (sample.covariance_left_out) ++counts.left_out;
  }
  return counts;
}

}  // namespace

void set_outcome_time(const Trajectory& T_world_camera_truth, double t_s, Score* score) {
  score->outcome_time_s = t_s;
  score->outcome_distance_m.reset();
  if (T_world_camera_truth.empty()) return;
  score->outcome_distance_m = T_world_camera_truth.path_length_m(ns_from_s(t_s));
}

Score score(const Trajectory& T_world_camera_truth,
            const EstimateTrack& estimate,
            const Options& options) {
  Score result;
  const Result<std::vector<MatchedPose>> matches =
      associate(T_world_camera_truth, estimate, options);
  const std::vector<FlownFrame> flown = flown_frames(estimate, options);
  result.covariances = covariances_of(estimate);
  // Divergence is judged over 10 s.
  const bool judged = matches && options.has_times;
  add_outcome(flown, judged ? *matches : std::vector<MatchedPose>{}, &result);
  if (result.outcome_time_s) {
    set_outcome_time(T_world_camera_truth, *result.outcome_time_s, &result);
  }
  if (!options.flight.empty()) result.position_auc_limit_m = options.auc_limit_m;
  if (!matches) {
    for (const AlignmentMode mode : all_alignment_modes()) {
      result.unavailable[mode] = matches.error().message;
    }
    return result;
  }
  for (const MatchedPose& match : *matches) result.matched_t_ns.push_back(match.t_ns);
  const std::vector<HeldPose> held =
      held_poses(T_world_camera_truth, flown, longest_map(estimate), options);
  for (const AlignmentMode mode : all_alignment_modes()) {
    AlignmentScore alignment;
    alignment.mode = mode;
    AlignmentRemarks remarks{common_notes(result, *matches, estimate), std::nullopt};
    const Result<Similarity> S_world_vo = align(*matches, mode, options, &remarks);
    if (!S_world_vo) {
      result.unavailable[mode] = S_world_vo.error().message;
      continue;
    }
    alignment.S_world_vo = *S_world_vo;
    alignment.notes = std::move(remarks.notes);
    alignment.degenerate = std::move(remarks.degenerate);
    add_errors(*matches, options, &alignment);
    alignment.position_rmse_hold_m = hold_rmse_m(held, *S_world_vo);
    if (result.position_auc_limit_m) {
      alignment.position_auc = area_under_curve(
          alignment.position_errors_m, result.frames, *result.position_auc_limit_m);
    }
    result.alignments[mode] = std::move(alignment);
  }
  return result;
}

}  // namespace overfly::evaluation
