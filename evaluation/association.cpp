#include "evaluation/association.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "core/time.hpp"

namespace overfly::evaluation {
namespace {

bool tracked(const EstimateSample& sample) { return sample.state == TrackingState::kTracking; }

std::string range_text(std::int64_t begin_ns, std::int64_t end_ns) {
  std::string text = "[";
  text += std::to_string(s_from_ns(begin_ns));
  text += ", ";
  text += std::to_string(s_from_ns(end_ns));
  return text += "] s";
}

/// If several frames match the same truth pose, keeps only the nearest, so that a truth with a
/// lower rate than the estimate does not count its poses twice.
void keep_nearest_of_each(const Trajectory& truth, std::vector<MatchedPose>* matches) {
  std::vector<MatchedPose> kept;
  std::size_t last_index = truth.size();
  std::int64_t last_distance_ns = 0;
  for (const MatchedPose& match : *matches) {
    const std::size_t index = truth.nearest(match.t_ns);
    const std::int64_t distance_ns = std::abs(truth.poses()[index].t_ns - match.t_ns);
    if (index != last_index) {
      kept.push_back(match);
    } else if (distance_ns < last_distance_ns) {
      kept.back() = match;
    } else {
      continue;
    }
    last_index = index;
    last_distance_ns = distance_ns;
  }
  *matches = std::move(kept);
}

/// The truth's own path where the estimate has a gap, in which the aircraft may have turned.
void add_detours(const Trajectory& truth, std::vector<MatchedPose>* matches) {
  for (std::size_t i = 1; i < matches->size(); ++i) {
    MatchedPose& now = (*matches)[i];
    const MatchedPose& before = (*matches)[i - 1];
    if (now.t_ns - before.t_ns <= kNsPerS) continue;
    const auto later = [](std::int64_t t_ns, const StampedPose& pose) { return t_ns < pose.t_ns; };
    auto between = std::upper_bound(truth.poses().begin(), truth.poses().end(), before.t_ns, later);
    Eigen::Vector3d last_m = before.T_world_camera.translation;
    double path_m = 0.0;
    for (; between != truth.poses().end() && between->t_ns < now.t_ns; ++between) {
      path_m += (between->pose.translation - last_m).norm();
      last_m = between->pose.translation;
    }
    const Eigen::Vector3d& end_m = now.T_world_camera.translation;
    path_m += (end_m - last_m).norm();
    now.detour_m = std::max(0.0, path_m - (end_m - before.T_world_camera.translation).norm());
  }
}

Error no_overlap(const Trajectory& truth,
                 const EstimateTrack& estimate,
                 int map_id,
                 const Options& options) {
  std::int64_t first_ns = INT64_MAX;
  std::int64_t last_ns = INT64_MIN;
  for (const EstimateSample& sample : estimate.samples) {
    if (!tracked(sample) || sample.map_id != map_id) continue;
    first_ns = std::min(first_ns, sample.t_ns);
    last_ns = std::max(last_ns, sample.t_ns);
  }
  std::string message = "no pose of the estimate has a matching truth pose: the estimate spans " +
                        range_text(first_ns, last_ns) + ", the truth " +
                        range_text(truth.begin_ns(), truth.end_ns());
  if (options.association == Association::kNearest) {
    message += ", and none is within " + std::to_string(s_from_ns(options.max_time_difference_ns)) +
               " s of another";
  }
  if (options.association == Association::kIndex) message += ", matched by index";
  return {ErrorCode::kInvalidArgument, message};
}

}  // namespace

const char* to_string(Association association) {
  switch (association) {
    case Association::kInterpolate:
      return "interpolate";
    case Association::kNearest:
      return "nearest";
    case Association::kIndex:
      return "index";
  }
  return "";
}

std::optional<FrameTruth> truth_of(const Trajectory& truth,
                                   const EstimateSample& sample,
                                   const Options& options) {
  if (truth.empty()) return std::nullopt;
  switch (options.association) {
    case Association::kInterpolate:
      if (const std::optional<Pose> pose = truth.at(sample.t_ns)) {
        return FrameTruth{sample.t_ns, *pose};
      }
      return std::nullopt;
    case Association::kNearest: {
      const StampedPose& nearest = truth.poses()[truth.nearest(sample.t_ns)];
      if (std::abs(nearest.t_ns - sample.t_ns) > options.max_time_difference_ns) {
        return std::nullopt;
      }
      return FrameTruth{sample.t_ns, nearest.pose};
    }
    case Association::kIndex:
      if (sample.frame < 0 || sample.frame >= static_cast<std::int64_t>(truth.size())) {
        return std::nullopt;
      }
      const StampedPose& same = truth.poses()[static_cast<std::size_t>(sample.frame)];
      return FrameTruth{same.t_ns, same.pose};
  }
  return std::nullopt;
}

std::optional<int> longest_map(const EstimateTrack& estimate) {
  std::map<int, int> frames;
  for (const EstimateSample& sample : estimate.samples) {
    if (tracked(sample)) ++frames[sample.map_id];
  }
  if (frames.empty()) return std::nullopt;
  return std::max_element(frames.begin(),
                          frames.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

Result<std::vector<MatchedPose>> associate(const Trajectory& T_world_camera_truth,
                                           const EstimateTrack& estimate,
                                           const Options& options) {
  const std::optional<int> map_id = longest_map(estimate);
  if (!map_id) return Error{ErrorCode::kInvalidArgument, "the estimate never tracked"};
  if (T_world_camera_truth.empty()) {
    return Error{ErrorCode::kInvalidArgument, "the truth contains no poses"};
  }
  std::vector<MatchedPose> matches;
  const EstimateSample* first = nullptr;
  for (const EstimateSample& sample : estimate.samples) {
    if (!tracked(sample) || sample.map_id != *map_id) continue;
    if (first == nullptr) first = &sample;
    if (const auto truth = truth_of(T_world_camera_truth, sample, options)) {
      matches.push_back({truth->t_ns,
                         truth->T_world_camera,
                         sample.T_vo_camera,
                         sample.scene_depth,
                         sample.covariance});
    }
  }
  if (options.association == Association::kNearest) {
    keep_nearest_of_each(T_world_camera_truth, &matches);
  }
  if (matches.empty()) return no_overlap(T_world_camera_truth, estimate, *map_id, options);
  matches.front().scene_depth = first->scene_depth;
  add_detours(T_world_camera_truth, &matches);
  return matches;
}

}  // namespace overfly::evaluation
