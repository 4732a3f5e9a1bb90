// Reads a run folder back into the rows of the live run.
#include "server/timeline/opened_run.hpp"

#include <optional>
#include <unordered_map>
#include <utility>

#include "server/files/file_field.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/estimator_tally.hpp"
#include "server/record/rows/vehicle_rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_records.hpp"
#include "server/scoring/run_metrics_json.hpp"
#include "server/timeline/live_alignment.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/timing/stage_timer.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The part of timings.json about one estimator, as far as it is readable.
struct EstimatorTimings {
  std::unordered_map<std::int64_t, double> latency_ms;  ///< by frame; filled at the end of the run
  std::optional<EstimatorUse> use;
};

EstimatorTimings read_timings(const FileField& timings, const std::string& estimator) {
  EstimatorTimings read;
  const auto estimators = timings.find("estimators");
  const auto entry = estimators ? estimators->find(estimator) : std::nullopt;
  if (!entry) return read;
  if (const auto use = entry->find("resources")) read.use = estimator_use_from(use->value());
  const auto frames = entry->find("frame");
  const auto latencies = entry->find("latency_ms");
  if (!frames || !latencies) return read;
  const std::vector<FileField> frame = frames->items();
  const std::vector<FileField> latency = latencies->items();
  for (std::size_t i = 0; i < frame.size() && i < latency.size(); ++i) {
    read.latency_ms[frame[i].integer()] = latency[i].number();
  }
  return read;
}

/// Keeps the first problem reported.
void tell_problem(RunInfo& info, const std::string& problem) {
  if (info.problem.empty()) info.problem = problem;
}

void append_estimates(const RunRecords& records,
                      std::size_t index,
                      const EstimatorTimings& timings,
                      RunTimeline& timeline) {
  const EstimatorRecords& estimator = records.estimators[index];
  const CameraRecords& camera = records.camera_of(estimator);
  LiveAlignment alignment(camera.T_body_camera);
  EstimatorStatus so_far;
  for (const EstimateRecord& record : estimator.records) {
    tally(record, std::nullopt, so_far);
    const FrameRow* frame = frame_row(camera, record.sample.frame);
    // A kill can leave the frames' file shorter than this one.
    if (record.dropped || frame == nullptr) continue;
    EstimateRow row;
    row.sample = record.sample;
    row.dropped_frames = so_far.dropped;
    row.unanswered_frames = so_far.unanswered;
    row.T_world_body = alignment.add(record.sample, {camera.frames.data(), frame + 1});
    if (const auto& S_world_vo = alignment.S_world_vo()) row.scale = S_world_vo->scale;
    const auto latency = timings.latency_ms.find(record.sample.frame);
    if (latency != timings.latency_ms.end()) row.latency_ms = latency->second;
    timeline.append_estimate(index, std::move(row), record.counters);
  }
}

void tell_status(const RunRecords& records,
                 std::size_t index,
                 const EstimatorTimings& timings,
                 RunTimeline& timeline) {
  EstimatorStatus status = tally_of(records, records.estimators[index]);
  status.use = timings.use;
  DurationList latencies;
  for (const auto& [frame, ms] : timings.latency_ms) latencies.ms.push_back(ms);
  status.latency = latencies.latencies();
  timeline.set_status(index, status);
}

Status append_logs(const fs::path& folder, RunTimeline& timeline) {
  return for_each_line(log_file(folder), [&](const Json& line) -> Status {
    const Result<LogRow> row = log_row_from(line);
    if (!row) return row.error();
    timeline.append_log(*row);
    return {};
  });
}

Status append_vehicle_statuses(const fs::path& folder, RunTimeline& timeline) {
  return for_each_line(vehicle_file(folder), [&](const Json& line) -> Status {
    const Result<VehicleStatus> status = vehicle_status_from(line);
    if (!status) return status.error();
    timeline.append_vehicle_status(*status);
    return {};
  });
}

void append_frames(const RunRecords& records, RunTimeline& timeline) {
  for (std::size_t i = 0; i < records.cameras.size(); ++i) {
    for (const FrameRow& row : records.cameras[i].frames) timeline.append_frame(row, i);
  }
}

/// The run can be played without its timings; an error in them is reported.
void append_answers(const fs::path& folder,
                    const RunRecords& records,
                    RunTimeline& timeline,
                    RunInfo& info) {
  const Result<Json> timings = read_json(timings_file(folder));
  if (!timings) tell_problem(info, timings.error().message);
  for (std::size_t i = 0; i < records.estimators.size(); ++i) {
    Result<EstimatorTimings> own = EstimatorTimings();
    if (timings) {
      own = guarded_fields(
          [&] { return read_timings(FileField(*timings), records.estimators[i].name); });
    }
    if (!own) tell_problem(info, timings_file(folder).string() + ": " + own.error().message);
    append_estimates(records, i, own ? *own : EstimatorTimings(), timeline);
    tell_status(records, i, own ? *own : EstimatorTimings(), timeline);
  }
}

void tell_cameras(const RunManifest& manifest, RunTimeline& timeline) {
  std::vector<RunCamera> cameras;
  for (const RunManifest::Camera& camera : manifest.cameras) {
    cameras.push_back({camera.name, camera.model, camera.T_body_camera});
  }
  if (!cameras.empty()) timeline.set_cameras(std::move(cameras));
}

/// The run can be played without its metrics; an error in them is reported.
void tell_metrics(const fs::path& folder, RunTimeline& timeline, RunInfo& info) {
  Result<RunMetrics> metrics = read_run_metrics(folder);
  if (metrics) {
    timeline.set_metrics(std::move(*metrics));
  } else if (metrics.error().code != ErrorCode::kNotFound) {
    tell_problem(info, metrics.error().message);
  }
}

}  // namespace

Result<OpenedRun> open_run(const fs::path& folder) {
  const FileStamp stamp = FileStamp::of(manifest_file(folder));
  Result<RunInfo> info = read_run_info(folder);
  if (!info) return info.error();
  if (info->status == RunStatus::kUnreadable) return Error{ErrorCode::kUnreadable, info->problem};
  Result<ReadManifest> manifest = read_run_manifest(folder);
  if (!manifest) return manifest.error();
  Result<RunRecords> records = read_run_records(folder, *manifest);
  if (!records) return records.error();
  info->estimators.clear();
  for (const EstimatorRecords& estimator : records->estimators) {
    info->estimators.push_back(estimator.name);
  }

  auto timeline = std::make_shared<RunTimeline>(*info, info->estimators);
  tell_cameras(manifest->values, *timeline);
  append_frames(*records, *timeline);
  append_answers(folder, *records, *timeline, *info);
  if (Status status = append_logs(folder, *timeline); !status) return status.error();
  if (Status status = append_vehicle_statuses(folder, *timeline); !status) return status.error();
  tell_metrics(folder, *timeline, *info);
  timeline->set_manifest_stamp(stamp);
  timeline->set_info(*info);
  return OpenedRun{std::move(timeline), std::move(manifest->values), std::move(*records)};
}

Result<std::shared_ptr<RunTimeline>> RunTimeline::open(const fs::path& folder) {
  Result<OpenedRun> opened = open_run(folder);
  if (!opened) return opened.error();
  return std::move(opened->timeline);
}

}  // namespace overfly::server
