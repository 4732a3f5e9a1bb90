#include "server/report/run/read_run.hpp"

#include <limits>
#include <memory>
#include <utility>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_records.hpp"
#include "server/report/run/run_warnings.hpp"
#include "server/scoring/metrics.hpp"
#include "server/timeline/run_timeline.hpp"

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

/// The body's pose in the world at each row, by one alignment.
std::vector<std::optional<Pose>> aligned_poses(const std::vector<EstimateRow>& rows,
                                               const EstimatorMetrics& metrics,
                                               const Pose& T_camera_body,
                                               AlignmentMode shown) {
  std::vector<std::optional<Pose>> poses(rows.size());
  const auto alignment = metrics.score.alignments.find(shown);
  if (alignment == metrics.score.alignments.end()) return poses;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const EstimateSample& sample = rows[i].sample;
    const bool scored = sample.state == TrackingState::kTracking && sample.map_id == metrics.map_id;
    if (scored) poses[i] = alignment->second.S_world_vo * sample.T_vo_camera * T_camera_body;
  }
  return poses;
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
    estimate.rows = timeline.estimates(i, 0, kAllRows);
    estimate.status = statuses.at(i);
    const Pose T_camera_body = records.camera_of(estimator).T_body_camera.inverse();
    estimate.T_world_body = aligned_poses(estimate.rows, scored, T_camera_body, shown);
    add_axis_errors(records, estimator, scored, shown, estimate);
  }
  return estimates;
}

}  // namespace

Result<ReportRun> read_report_run(const fs::path& folder, AlignmentMode shown) {
  const Result<std::shared_ptr<RunTimeline>> timeline = RunTimeline::open(folder);
  if (!timeline) return timeline.error();
  const Result<ReadManifest> manifest = read_run_manifest(folder);
  if (!manifest) return manifest.error();
  ReportRun run;
  run.folder = folder;
  run.id = folder_name(folder);
  run.info = (*timeline)->info();
  if (Status status = check_over(folder, run.info); !status) return status.error();
  const Result<RunRecords> records = read_run_records(folder, *manifest);
  if (!records) return records.error();
  if (records->main_camera().frames.empty()) {
    return Error{ErrorCode::kNotFound, folder.string() + ": the run recorded no frames"};
  }
  run.manifest = manifest->values;
  run.metrics = metrics_from(*records);
  run.cameras = (*timeline)->cameras();
  for (std::size_t i = 0; i < run.cameras.size(); ++i) {
    run.frames.push_back((*timeline)->frames(0, kAllRows, i));
  }
  run.estimates = estimates_in(**timeline, *records, run.metrics, shown);
  RunWarnings warnings(run, (*timeline)->metrics().get(), (*timeline)->logs(0, kAllRows));
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
