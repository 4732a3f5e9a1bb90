#include "server/report/run/read_run.hpp"

#include <limits>
#include <utility>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/report/run/run_warnings.hpp"
#include "server/scoring/metrics.hpp"
#include "server/timeline/opened_run.hpp"

namespace overfly::server::report {
namespace {

namespace fs = std::filesystem;
using evaluation::AlignmentMode;

constexpr std::size_t kAllRows = std::numeric_limits<std::size_t>::max();

Status check_over(const fs::path& folder, const RunInfo& info) {
  if (info.status != RunStatus::kRunning && info.status != RunStatus::kQueued) return {};
  return Error{ErrorCode::kConflict,
               folder.string() + ": the run is " + to_string(info.status) +
                   "; it can be reported when it is over"};
}

/// The answers, with the body's pose by the alignment that is shown.
std::vector<ReportAnswer> answers_of(const std::vector<EstimateRow>& rows,
                                     const EstimatorMetrics& metrics,
                                     const Pose& T_camera_body,
                                     AlignmentMode shown) {
  const auto alignment = metrics.score.alignments.find(shown);
  std::vector<ReportAnswer> answers;
  answers.reserve(rows.size());
  for (const EstimateRow& row : rows) {
    const EstimateSample& sample = row.sample;
    ReportAnswer& answer = answers.emplace_back();
    answer.t_ns = sample.t_ns;
    answer.state = sample.state;
    answer.scored = sample.state == TrackingState::kTracking && sample.map_id == metrics.map_id;
    answer.latency_ms = row.latency_ms;
    if (answer.scored && alignment != metrics.score.alignments.end()) {
      answer.T_world_body = alignment->second.S_world_vo * sample.T_vo_camera * T_camera_body;
    }
  }
  return answers;
}

/// Errors in the axes of the path: their means by every alignment, and each pose's by the one
/// shown.
void add_axis_errors(const RunRecords& records,
                     const EstimatorRecords& estimator,
                     const EstimatorMetrics& metrics,
                     AlignmentMode shown,
                     ReportEstimate& estimate) {
  const CameraRecords& camera = records.camera_of(estimator);
  const Result<Trajectory> truth = truth_of(camera);
  if (!truth) return;
  const auto matches = evaluation::associate(*truth, track_of(estimator), {});
  if (!matches) return;
  for (const auto& [mode, alignment] : metrics.score.alignments) {
    std::vector<evaluation::AxisError> errors =
        evaluation::axis_errors(*truth, *matches, alignment.S_world_vo, camera.T_body_camera);
    estimate.axis_rmse[mode] = evaluation::rmse_of(errors);
    if (mode == shown) estimate.axis_errors = std::move(errors);
  }
}

std::vector<ReportEstimate> estimates_in(const RunTimeline& timeline,
                                         const RunRecords& records,
                                         const RunMetrics& metrics,
                                         AlignmentMode shown) {
  const std::vector<EstimatorStatus> statuses = timeline.statuses();
  std::vector<ReportEstimate> estimates;
  for (std::size_t i = 0; i < records.estimators.size(); ++i) {
    const EstimatorRecords& estimator = records.estimators[i];
    const EstimatorMetrics& scored = metrics.estimators.at(estimator.name);
    ReportEstimate& estimate = estimates.emplace_back();
    estimate.name = estimator.name;
    estimate.camera = estimator.camera;
    estimate.status = statuses.at(i);
    const Pose T_camera_body = records.camera_of(estimator).T_body_camera.inverse();
    estimate.answers = answers_of(timeline.estimates(i, 0, kAllRows), scored, T_camera_body, shown);
    add_axis_errors(records, estimator, scored, shown, estimate);
  }
  return estimates;
}

/// Errors of single poses need much memory, and are drawn by one alignment.
void drop_errors_not_shown(AlignmentMode shown, RunMetrics& metrics) {
  for (auto& [name, estimator] : metrics.estimators) {
    for (auto& [mode, alignment] : estimator.score.alignments) {
      if (mode == shown) continue;
      alignment.position_errors_m = std::vector<double>();  // "= {}" would keep the memory
      alignment.rotation_errors_deg = std::vector<double>();
    }
  }
}

}  // namespace

Result<ReportRun> read_report_run(const fs::path& folder, AlignmentMode shown) {
  Result<OpenedRun> opened = open_run(folder);
  if (!opened) return opened.error();
  const RunTimeline& timeline = *opened->timeline;
  RunRecords& records = opened->records;
  ReportRun run;
  run.folder = folder;
  run.id = folder_name(folder);
  run.info = timeline.info();
  if (Status status = check_over(folder, run.info); !status) return status.error();
  if (records.main_camera().frames.empty()) {
    return Error{ErrorCode::kNotFound, folder.string() + ": the run recorded no frames"};
  }
  run.manifest = std::move(opened->manifest);
  run.metrics = metrics_from(records);
  run.cameras = timeline.cameras();
  run.estimates = estimates_in(timeline, records, run.metrics, shown);
  for (CameraRecords& camera : records.cameras) {
    camera.frames.shrink_to_fit();
    run.frames.push_back(std::move(camera.frames));
  }
  drop_errors_not_shown(shown, run.metrics);
  RunWarnings warnings(run, timeline.metrics().get(), timeline.logs(0, kAllRows));
  if (Result<nlohmann::json> scenario = read_json(scenario_file(folder))) {
    run.scenario = std::move(*scenario);
  } else {
    warnings.add({"warning", "", scenario.error().message, std::nullopt, 1});
  }
  run.warnings_left_out = warnings.left_out();
  run.warnings = std::move(warnings).list();
  return run;
}

}  // namespace overfly::server::report
