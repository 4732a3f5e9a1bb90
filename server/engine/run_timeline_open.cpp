// RunTimeline::open: a run folder read back into the rows that its run gave out.
#include <unordered_map>
#include <utility>

#include "server/engine/live_alignment.hpp"
#include "server/engine/run_folder.hpp"
#include "server/engine/run_rows.hpp"
#include "server/engine/run_timeline.hpp"
#include "server/engine/whole_file.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using FrameRecords = std::unordered_map<std::int64_t, FrameRecord>;

Error in_row(const Error& error, const fs::path& file, std::size_t row) {
  return error.in(file.string() + ", row " + std::to_string(row + 1));
}

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

Result<FrameRecords> read_frames(const fs::path& folder, RunTimeline& timeline) {
  const fs::path file = frames_file(folder);
  const Result<std::vector<Json>> lines = read_lines(file);
  if (!lines) return lines.error();
  FrameRecords records;
  for (std::size_t i = 0; i < lines->size(); ++i) {
    Result<FrameRecord> record = frame_record_from((*lines)[i], timeline.T_body_camera());
    if (!record) return in_row(record.error(), file, i);
    timeline.append_frame(record->row);
    records.emplace(record->row.frame, *record);
  }
  return records;
}

Status read_estimates(const fs::path& folder,
                      std::size_t estimator,
                      const FrameRecords& frames,
                      const Json& timings,
                      RunTimeline& timeline) {
  const std::string& name = timeline.estimators()[estimator];
  const fs::path file = estimate_file(folder, name);
  const Result<std::vector<Json>> lines = read_lines(file);
  if (!lines) return lines.error();
  const auto latencies = read_latencies(timings, name);
  LiveAlignment alignment(timeline.T_body_camera());
  for (std::size_t i = 0; i < lines->size(); ++i) {
    const Result<EstimateRecord> record = estimate_record_from((*lines)[i]);
    if (!record) return in_row(record.error(), file, i);
    if (record->dropped) continue;
    const auto frame = frames.find(record->sample.frame);
    if (frame == frames.end()) continue;  // a kill can cut the frames' file shorter than this one
    EstimateRow row;
    row.sample = record->sample;
    row.T_world_body =
        alignment.add(record->sample, frame->second.row.T_world_camera, frame->second.axis_depth_m);
    const auto latency = latencies.find(record->sample.frame);
    if (latency != latencies.end()) row.latency_ms = latency->second;
    timeline.append_estimate(estimator, row);
  }
  return {};
}

Status read_logs(const fs::path& folder, RunTimeline& timeline) {
  const fs::path file = log_file(folder);
  const Result<std::vector<Json>> lines = read_lines(file);
  if (!lines) return lines.error();
  for (std::size_t i = 0; i < lines->size(); ++i) {
    const Result<LogRow> row = log_row_from((*lines)[i]);
    if (!row) return in_row(row.error(), file, i);
    timeline.append_log(*row);
  }
  return {};
}

/// Camera and mount; a run that failed before it had them keeps the defaults.
Status read_camera(const Json& manifest, const fs::path& folder, RunTimeline& timeline) {
  if (!manifest.contains("camera")) return {};
  const Json& entry = manifest.at("camera");
  const Result<PinholeCamera> camera = camera_from(entry);
  if (!camera) return camera.error().in(manifest_file(folder).string() + ": camera");
  const Result<Pose> mount = pose_from(entry.value("T_body_camera", Json::object()));
  if (!mount) return mount.error().in(manifest_file(folder).string() + ": camera.T_body_camera");
  timeline.set_camera(*camera, *mount);
  return {};
}

}  // namespace

Result<std::shared_ptr<RunTimeline>> RunTimeline::open(const fs::path& folder) {
  const Result<RunInfo> info = read_run_info(folder);
  if (!info) return info.error();
  const Result<Json> manifest = read_json(manifest_file(folder));
  if (!manifest) return manifest.error();
  auto timeline = std::make_shared<RunTimeline>(*info, info->estimators);
  if (Status status = read_camera(*manifest, folder, *timeline); !status) return status.error();

  Json timings = Json::object();
  if (Result<Json> read = read_json(timings_file(folder)); read) timings = std::move(*read);
  const Result<FrameRecords> frames = read_frames(folder, *timeline);
  if (!frames) return frames.error();
  for (std::size_t i = 0; i < timeline->estimators().size(); ++i) {
    if (Status status = read_estimates(folder, i, *frames, timings, *timeline); !status) {
      return status.error();
    }
  }
  if (Status status = read_logs(folder, *timeline); !status) return status.error();
  if (fs::exists(metrics_file(folder))) {
    Result<Json> metrics = read_json(metrics_file(folder));
    if (!metrics) return metrics.error();
    timeline->set_metrics(std::move(*metrics));
  }
  return timeline;
}

}  // namespace overfly::engine
