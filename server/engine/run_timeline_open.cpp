// RunTimeline::open: a run folder read back into the rows that its run gave out.
#include <unordered_map>
#include <utility>

#include "server/engine/estimator_tally.hpp"
#include "server/engine/live_alignment.hpp"
#include "server/engine/run_folder.hpp"
#include "server/engine/run_records.hpp"
#include "server/engine/run_timeline.hpp"
#include "server/engine/stage_timer.hpp"
#include "server/engine/whole_file.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Latencies by frame, as timings.json has them once the run is over.
std::unordered_map<std::int64_t, double> read_latencies(const Json& timings,
                                                        const std::string& estimator) {
  std::unordered_map<std::int64_t, double> latencies;
  const Json::json_pointer frames("/estimators/" + estimator + "/frame");
  const Json::json_pointer values("/estimators/" + estimator + "/latency_ms");
  if (!timings.contains(frames) || !timings.contains(values)) return latencies;
  const Json& frame = timings.at(frames);
  const Json& latency = timings.at(values);
  for (std::size_t i = 0; i < frame.size() && i < latency.size(); ++i) {
    if (frame[i].is_number_integer() && latency[i].is_number()) {
      latencies[frame[i].get<std::int64_t>()] = latency[i].get<double>();
    }
  }
  return latencies;
}

void append_estimates(const RunRecords& records,
                      std::size_t index,
                      const Json& timings,
                      RunTimeline& timeline) {
  const EstimatorRecords& estimator = records.estimators[index];
  const auto latencies = read_latencies(timings, estimator.name);
  LiveAlignment alignment(records.mount_of(estimator.camera));
  for (const EstimateRecord& record : estimator.records) {
    const FrameRecord* frame = frame_record(records, estimator.camera, record.sample.frame);
    // A kill can cut the frames' file shorter than this one.
    if (record.dropped || frame == nullptr) continue;
    EstimateRow row;
    row.sample = record.sample;
    row.T_world_body = alignment.add(record.sample, frame->row.T_world_camera, frame->axis_depth_m);
    const auto latency = latencies.find(record.sample.frame);
    if (latency != latencies.end()) row.latency_ms = latency->second;
    timeline.append_estimate(index, row);
  }
}

void tell_status(const RunRecords& records,
                 std::size_t index,
                 const Json& timings,
                 RunTimeline& timeline) {
  const EstimatorRecords& estimator = records.estimators[index];
  EstimatorStatus status = tally_of(records, estimator);
  const Json::json_pointer use("/estimators/" + estimator.name + "/resources");
  if (timings.contains(use)) status.use = estimator_use_from(timings.at(use));
  DurationList latencies;
  for (const auto& [frame, ms] : read_latencies(timings, estimator.name)) {
    latencies.ms.push_back(ms);
  }
  status.latency = latencies.latencies();
  timeline.set_status(index, status);
}

Status append_logs(const fs::path& folder, RunTimeline& timeline) {
  const fs::path file = log_file(folder);
  const Result<std::vector<Json>> lines = read_lines(file);
  if (!lines) return lines.error();
  for (std::size_t i = 0; i < lines->size(); ++i) {
    const Result<LogRow> row = log_row_from((*lines)[i]);
    if (!row) return row.error().in(file.string() + ", row " + std::to_string(i + 1));
    timeline.append_log(*row);
  }
  return {};
}

Status append_records(const fs::path& folder, const RunRecords& records, RunTimeline& timeline) {
  Json timings = Json::object();
  if (Result<Json> read = read_json(timings_file(folder)); read) timings = std::move(*read);
  for (const FrameRecord& record : records.frames) timeline.append_frame(record.row);
  for (std::size_t i = 0; i < records.other_cameras.size(); ++i) {
    for (const FrameRecord& record : records.other_cameras[i].frames) {
      timeline.append_frame(record.row, i + 1);
    }
  }
  for (std::size_t i = 0; i < records.estimators.size(); ++i) {
    append_estimates(records, i, timings, timeline);
    tell_status(records, i, timings, timeline);
  }
  return append_logs(folder, timeline);
}

/// Runs of one camera may say so in `camera` alone.
Status tell_cameras(const Json& manifest, const RunRecords& records, RunTimeline& timeline) {
  if (!manifest.contains("camera")) return {};
  Json entries = manifest.value("cameras", Json::array());
  if (entries.empty()) entries.push_back(manifest.at("camera"));
  std::vector<RunCamera> cameras;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Result<CameraModel> model = camera_model_from(entries[i]);
    if (!model) return model.error().in("cameras." + std::to_string(i));
    cameras.push_back({entries[i].value("name", ""), *model, records.mount_of(i)});
  }
  timeline.set_cameras(std::move(cameras));
  return {};
}

}  // namespace

Result<std::shared_ptr<RunTimeline>> RunTimeline::open(const fs::path& folder) {
  const Result<RunInfo> info = read_run_info(folder);
  if (!info) return info.error();
  const Result<Json> manifest = read_json(manifest_file(folder));
  if (!manifest) return manifest.error();
  const Result<RunRecords> records = read_run_records(folder);
  if (!records) return records.error();

  auto timeline = std::make_shared<RunTimeline>(*info, info->estimators);
  if (Status status = tell_cameras(*manifest, *records, *timeline); !status) {
    return status.error().in(manifest_file(folder).string());
  }
  if (Status status = append_records(folder, *records, *timeline); !status) return status.error();
  if (fs::exists(metrics_file(folder))) {
    Result<Json> metrics = read_json(metrics_file(folder));
    if (!metrics) return metrics.error();
    timeline->set_metrics(std::move(*metrics));
  }
  return timeline;
}

}  // namespace overfly::engine
