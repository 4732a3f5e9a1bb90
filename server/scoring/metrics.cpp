#include "server/scoring/metrics.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/motion/trajectory_io.hpp"
#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/estimator_tally.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/scenario/estimator_spec.hpp"
#include "server/scoring/camera_metrics.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

FlightMetrics flight_metrics_from(const CameraRecords& main_camera) {
  FlightMetrics flight;
  if (main_camera.frames.empty()) return flight;
  flight.duration_s = s_from_ns(main_camera.frames.back().t_ns);
  if (const Result<Trajectory> truth = truth_of(main_camera)) {
    flight.path_length_m = truth->path_length_m();
  }
  return flight;
}

std::vector<std::int64_t> dropped_frames(const EstimatorRecords& estimator) {
  std::vector<std::int64_t> dropped;
  for (const EstimateRecord& record : estimator.records) {
    if (record.dropped) dropped.push_back(record.sample.frame);
  }
  return dropped;
}

evaluation::Score score_of(const RunRecords& records, const EstimatorRecords& estimator) {
  evaluation::Options options;
  const CameraRecords& camera = records.camera_of(estimator);
  options.flight = flight_frames(records, camera);
  options.T_body_camera = camera.T_body_camera;
  if (const auto initial = initial_frame(records, estimator)) {
    options.init_true_depth_m = initial->true_depth_m;
  }
  const Result<Trajectory> known = truth_of(camera);
  const Trajectory truth = known ? *known : Trajectory();
  evaluation::Score score = evaluation::score(truth, track_of(estimator), options);
  for (const EstimateRecord& record : estimator.records) {
    if (record.crash.empty()) continue;
    score.outcome = record.hung ? evaluation::Outcome::kTimeout : evaluation::Outcome::kCrashed;
    const FrameRow* const frame = frame_row(camera, record.sample.frame);
    evaluation::set_outcome_time(
        truth, s_from_ns(frame != nullptr ? frame->t_ns : record.sample.t_ns), &score);
    break;
  }
  return score;
}

EstimatorMetrics estimator_metrics_from(const RunRecords& records,
                                        const EstimatorRecords& estimator) {
  EstimatorMetrics metrics;
  metrics.type = estimator.type;
  metrics.test_estimator = is_test_estimator(estimator.type);
  if (estimator.camera != kMainCamera) metrics.camera = records.camera_of(estimator).name;
  metrics.score = score_of(records, estimator);
  if (const auto initial = initial_frame(records, estimator)) metrics.map_id = initial->map_id;
  const EstimatorStatus counts = tally_of(records, estimator);
  metrics.answered = counts.answered;
  metrics.unanswered = counts.unanswered;
  metrics.hashes_compared = counts.hashes_compared;
  metrics.hash_mismatches = counts.hash_mismatches;
  if (!counts.crash.empty()) metrics.crash = counts.crash;
  const std::vector<std::int64_t> dropped = dropped_frames(estimator);
  metrics.dropped_frames = static_cast<std::int64_t>(dropped.size());
  metrics.dropped_frame_ranges = ranges_of(dropped);
  return metrics;
}

/// Only the piece that is scored: those before and after a reset have no common origin or scale.
Result<RunTrajectory> scored_piece(const RunRecords& records, const EstimatorRecords& estimator) {
  RunTrajectory piece;
  const auto initial = initial_frame(records, estimator);
  if (!initial) return piece;
  if (initial->scene_depth) piece.comments["init_scene_depth"] = number_text(*initial->scene_depth);
  if (initial->true_depth_m) {
    piece.comments["init_true_depth"] = number_text(*initial->true_depth_m);
  }
  for (const EstimateRecord& record : estimator.records) {
    if (record.dropped || record.sample.state != TrackingState::kTracking) continue;
    if (record.sample.map_id != initial->map_id) continue;
    const Status added = piece.poses.append({record.sample.t_ns, record.sample.T_vo_camera});
    if (!added) return added.error().in("estimator " + estimator.name);
  }
  return piece;
}

}  // namespace

RunMetrics metrics_from(const RunRecords& records) {
  RunMetrics metrics;
  metrics.cameras.clear();
  for (const CameraRecords& camera : records.cameras) {
    metrics.cameras.push_back(camera_metrics_from(camera));
  }
  std::vector<std::int64_t> late;
  for (const evaluation::FlightFrame& frame : records.late_frames) late.push_back(frame.frame);
  metrics.late_frames = static_cast<std::int64_t>(late.size());
  metrics.late_frame_ranges = ranges_of(late);
  metrics.flight = flight_metrics_from(records.main_camera());
  for (const EstimatorRecords& estimator : records.estimators) {
    metrics.estimators[estimator.name] = estimator_metrics_from(records, estimator);
  }
  return metrics;
}

const CameraMetrics& RunMetrics::camera_of(const EstimatorMetrics& estimator) const {
  for (std::size_t i = kMainCamera + 1; i < cameras.size(); ++i) {
    if (cameras[i].name == estimator.camera) return cameras[i];
  }
  return cameras.at(kMainCamera);
}

std::map<std::string, std::string> never_ran(const RunMetrics& metrics) {
  std::map<std::string, std::string> reasons;
  for (const auto& [name, estimator] : metrics.estimators) {
    if (estimator.answered == 0 && estimator.crash) reasons[name] = *estimator.crash;
  }
  return reasons;
}

bool is_texture_limited(const RunMetrics& metrics) {
  return std::any_of(metrics.cameras.begin(),
                     metrics.cameras.end(),
                     [](const CameraMetrics& camera) { return camera.texture.limited; });
}

Result<std::vector<RunTrajectory>> trajectories_of(const fs::path& folder,
                                                   const RunRecords& records) {
  std::vector<RunTrajectory> trajectories;
  for (std::size_t i = 0; i < records.cameras.size(); ++i) {
    Result<Trajectory> truth = truth_of(records.cameras[i]);
    if (!truth) return truth.error();
    trajectories.push_back(
        {CameraFiles(folder, i, records.cameras[i].name).truth(), std::move(*truth), {}});
  }
  for (const EstimatorRecords& estimator : records.estimators) {
    Result<RunTrajectory> piece = scored_piece(records, estimator);
    if (!piece) return piece.error();
    piece->file = estimate_tum_file(folder, estimator.name);
    trajectories.push_back(std::move(*piece));
  }
  return trajectories;
}

Status write_trajectories(const fs::path& folder, const RunRecords& records) {
  const Result<std::vector<RunTrajectory>> trajectories = trajectories_of(folder, records);
  if (!trajectories) return trajectories.error();
  for (const RunTrajectory& trajectory : *trajectories) {
    Status written = write_tum(trajectory.file, trajectory.poses, trajectory.comments);
    if (!written) return written;
  }
  return {};
}

Result<RunTrajectory> missing_trajectory(const fs::path& folder, const fs::path& file) {
  const Result<RunInfo> info = read_run_info(folder);
  if (!info) return info.error();
  const Error none{ErrorCode::kNotFound, file.filename().string() + ": no such trajectory"};
  if (info->status == RunStatus::kRunning) return none;
  const Result<RunRecords> records = read_run_records(folder);
  if (!records) return records.error();
  Result<std::vector<RunTrajectory>> trajectories = trajectories_of(folder, *records);
  if (!trajectories) return trajectories.error();
  for (RunTrajectory& trajectory : *trajectories) {
    if (trajectory.file == file) return std::move(trajectory);
  }
  return none;
}

Result<RunMetrics> write_derived(const fs::path& folder, const RunRecords& records) {
  if (Status status = write_trajectories(folder, records); !status) return status.error();
  RunMetrics metrics = metrics_from(records);
  const Status written = write_json(metrics_file(folder), json_from(metrics));
  if (!written) return written.error();
  return metrics;
}

}  // namespace overfly::server
