#include "server/scoring/metrics.hpp"

#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "core/trajectory_io.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/estimator_tally.hpp"
#include "server/record/run_folder.hpp"
#include "server/scenario/estimator_spec.hpp"
#include "server/scoring/camera_metrics.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

template <typename Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json flight_metrics(const RunRecords& records, const Trajectory& truth) {
  const double duration_s =
      records.frames.empty() ? 0.0 : s_from_ns(records.frames.back().row.t_ns);
  return {{"duration_s", duration_s}, {"path_length_m", truth.path_length_m()}};
}

std::vector<std::int64_t> dropped_frames(const EstimatorRecords& estimator) {
  std::vector<std::int64_t> dropped;
  for (const EstimateRecord& record : estimator.records) {
    if (record.dropped) dropped.push_back(record.sample.frame);
  }
  return dropped;
}

evaluation::Score score_of(const RunRecords& records,
                           const Trajectory& truth,
                           const EstimatorRecords& estimator) {
  evaluation::Options options;
  options.flight = flight_frames(records, estimator.camera);
  options.T_body_camera = records.mount_of(estimator.camera);
  if (const auto initial = initial_frame(records, estimator)) {
    options.init_true_depth_m = initial->true_depth_m;
  }
  evaluation::Score score = evaluation::score(truth, track_of(estimator), options);
  for (const EstimateRecord& record : estimator.records) {
    if (record.crash.empty()) continue;
    score.outcome = evaluation::Outcome::kCrashed;
    score.outcome_time_s = s_from_ns(record.sample.t_ns);
    break;
  }
  return score;
}

std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

Status write_trajectories(const fs::path& folder,
                          const RunRecords& records,
                          const Trajectory& truth) {
  if (Status status = write_tum(truth_file(folder), truth); !status) return status;
  for (std::size_t i = 0; i < records.other_cameras.size(); ++i) {
    const Result<Trajectory> seen = truth_of(records, i + 1);
    if (!seen) return seen.error();
    const fs::path file = camera_truth_file(folder, records.other_cameras[i].name);
    if (Status status = write_tum(file, *seen); !status) return status;
  }
  for (const EstimatorRecords& estimator : records.estimators) {
    const auto initial = initial_frame(records, estimator);
    Trajectory trajectory;
    std::map<std::string, std::string> comments;
    if (initial && initial->scene_depth) {
      comments["init_scene_depth"] = number_text(*initial->scene_depth);
    }
    if (initial && initial->true_depth_m) {
      comments["init_true_depth"] = number_text(*initial->true_depth_m);
    }
    for (const EstimateRecord& record : estimator.records) {
      // Only the scored piece: pieces before and after a reset have no common origin or scale.
      if (record.dropped || record.sample.state != TrackingState::kTracking) continue;
      if (record.sample.map_id != initial->map_id) continue;
      const Status added = trajectory.append({record.sample.t_ns, record.sample.T_vo_camera});
      if (!added) return added.error().in("estimator " + estimator.name);
    }
    const fs::path file = estimate_tum_file(folder, estimator.name);
    if (Status status = write_tum(file, trajectory, comments); !status) return status;
  }
  return {};
}

}  // namespace

Json json_from(const evaluation::AlignmentScore& score) {
  Json relative = Json::array();
  for (const evaluation::RelativeError& error : score.relative) {
    relative.push_back({{"length_m", error.length_m},
                        {"pairs", error.pairs},
                        {"translation_percent", error.translation_percent},
                        {"rotation_deg_per_100m", error.rotation_deg_per_100m}});
  }
  Json S_world_vo = json_from(Pose{score.S_world_vo.rotation, score.S_world_vo.translation});
  S_world_vo["scale"] = score.S_world_vo.scale;
  using Errors = evaluation::ErrorStatistics;
  const auto rotation = [&](double Errors::*statistic) {
    return score.rotation_deg ? Json((*score.rotation_deg).*statistic) : Json(nullptr);
  };
  return {
      {"scale", score.S_world_vo.scale},
      {"S_world_vo", std::move(S_world_vo)},
      {"matched", score.matched},
      {"position_rmse_m", score.position_m.rmse},
      {"position_mean_m", score.position_m.mean},
      {"position_median_m", score.position_m.median},
      {"position_max_m", score.position_m.max},
      {"position_rmse_hold_m", score.position_rmse_hold_m},
      {"rotation_rmse_deg", rotation(&Errors::rmse)},
      {"rotation_mean_deg", rotation(&Errors::mean)},
      {"rotation_median_deg", rotation(&Errors::median)},
      {"rotation_max_deg", rotation(&Errors::max)},
      {"rotation_euler_norm_rmse_deg",
       score.rotation_euler_norm_deg ? Json(score.rotation_euler_norm_deg->rmse) : Json(nullptr)},
      {"degenerate", or_null(score.degenerate)},
      {"relative", relative},
      {"notes", score.notes}};
}

Json alignments_json(const evaluation::Score& score) {
  Json alignments = Json::object();
  for (const auto& [mode, alignment] : score.alignments) {
    alignments[evaluation::to_string(mode)] = json_from(alignment);
  }
  return alignments;
}

Json unavailable_json(const evaluation::Score& score) {
  Json unavailable = Json::object();
  for (const auto& [mode, reason] : score.unavailable) {
    unavailable[evaluation::to_string(mode)] = reason;
  }
  return unavailable;
}

Json json_from(const evaluation::Score& score) {
  return {{"outcome", evaluation::to_string(score.outcome)},
          {"outcome_time_s", or_null(score.outcome_time_s)},
          {"reset_count", score.reset_count},
          {"coverage", score.coverage},
          {"initialised_at_s", or_null(score.initialised_at_s)},
          {"frames", score.frames},
          {"tracked_frames", score.tracked_frames},
          {"alignments", alignments_json(score)},
          {"unavailable", unavailable_json(score)}};
}

Json metrics_from(const RunRecords& records) {
  const Result<Trajectory> truth = truth_of(records);
  const Trajectory trajectory = truth ? *truth : Trajectory();
  Json estimators = Json::object();
  for (const EstimatorRecords& estimator : records.estimators) {
    const Result<Trajectory> seen = truth_of(records, estimator.camera);
    Json entry = json_from(score_of(records, seen ? *seen : Trajectory(), estimator));
    const std::vector<std::int64_t> dropped = dropped_frames(estimator);
    const auto initial = initial_frame(records, estimator);
    entry["map_id"] = initial ? Json(initial->map_id) : Json(nullptr);
    entry["type"] = estimator.type;
    entry["test_estimator"] = is_test_estimator(estimator.type);
    const EstimatorStatus counts = tally_of(records, estimator);
    entry["answered"] = counts.answered;
    entry["crash"] = counts.crash.empty() ? Json(nullptr) : Json(counts.crash);
    entry["unanswered"] = counts.unanswered;
    entry["hashes_compared"] = counts.hashes_compared;
    entry["hash_mismatches"] = counts.hash_mismatches;
    entry["dropped_frames"] = dropped.size();
    entry["dropped_frame_ranges"] = ranges_of(dropped);
    estimators[estimator.name] = std::move(entry);
  }
  Json metrics = {{"format_version", 1},
                  {"camera", camera_metrics(records)},
                  {"texture", texture_json(records.frames)},
                  {"flight", flight_metrics(records, trajectory)},
                  {"estimators", std::move(estimators)}};
  if (!records.other_cameras.empty()) metrics["cameras"] = other_cameras_metrics(records);
  return metrics;
}

std::map<std::string, std::string> never_ran(const Json& metrics) {
  std::map<std::string, std::string> reasons;
  for (const auto& [name, entry] : metrics.at("estimators").items()) {
    if (entry.at("answered") > 0 || !entry.at("crash").is_string()) continue;
    reasons[name] = entry.at("crash").get<std::string>();
  }
  return reasons;
}

Result<Json> write_derived(const fs::path& folder, const RunRecords& records) {
  const Result<Trajectory> truth = truth_of(records);
  if (!truth) return truth.error();
  if (Status status = write_trajectories(folder, records, *truth); !status) return status.error();
  Json metrics = metrics_from(records);
  if (Status status = write_json(metrics_file(folder), metrics); !status) return status.error();
  return metrics;
}

}  // namespace overfly::engine
