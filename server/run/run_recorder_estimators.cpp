// RunRecorder: answers, log lines and resource use of the estimators.
#include <string_view>
#include <utility>

#include "core/measure/process_memory.hpp"
#include "server/files/jpeg.hpp"
#include "server/record/estimator_tally.hpp"
#include "server/record/map_points.hpp"
#include "server/record/rows/rows.hpp"
#include "server/run/run_recorder.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kDebugQuality = 85;
/// Maximum for one estimator in the run's log; its output.log has all lines.
constexpr int kMaxLogRows = 1000;
constexpr std::size_t kMaxLogBytes = 1000;

/// The level given by the line's prefix.
const char* level_of(std::string_view line) {
  if (line.starts_with("error: ")) return "error";
  return line.starts_with("warning: ") ? "warning" : "info";
}

Json use_json(const EstimatorStatus& status) {
  return status.use ? json_from(*status.use) : Json(nullptr);
}

}  // namespace

Status RunRecorder::add_event(std::size_t estimator, EstimatorEvent event) {
  EstimatorState& state = estimators_[estimator];
  const std::int64_t unanswered_before = state.status.unanswered;
  if (Status status = state.lines.append(json_from(event.record)); !status) return status;
  const CameraRecords& camera = records_.camera_of(records_.estimators[estimator]);
  const FrameRow* frame = frame_row(camera, event.record.sample.frame);
  tally(event.record, frame != nullptr ? frame->image_crc32 : std::nullopt, state.status);
  if (unanswered_before == 0 && state.status.unanswered > 0) {
    const EstimateSample& sample = event.record.sample;
    Status logged =
        log(sample.t_ns,
            "warning",
            info_.estimators[estimator] + " did not answer frame " + std::to_string(sample.frame) +
                " within answer_timeout_s: this and later such frames are counted as "
                "unanswered");
    if (!logged) return logged;
  }
  if (!event.record.dropped) {
    if (Status status = add_answer(estimator, event); !status) return status;
  }
  tell_status(estimator, event);
  records_.estimators[estimator].records.push_back(std::move(event.record));
  return {};
}

void RunRecorder::tell_status(std::size_t estimator, const EstimatorEvent& event) {
  EstimatorState& state = estimators_[estimator];
  if (event.use) {
    state.status.use = event.use;
    state.status.latency = state.latency_so_far.summary();
  }
  timeline_->set_status(estimator, state.status);
}

void RunRecorder::set_use(std::size_t estimator, const EstimatorUse& use) {
  EstimatorState& state = estimators_[estimator];
  state.status.use = use;
  state.status.latency = state.latency.latencies();
  timeline_->set_status(estimator, state.status);
}

Status RunRecorder::add_estimator_log(std::size_t estimator,
                                      std::int64_t t_ns,
                                      const std::vector<std::string>& lines) {
  EstimatorState& state = estimators_[estimator];
  const std::string& name = info_.estimators[estimator];
  for (const std::string& line : lines) {
    if (state.log_rows > kMaxLogRows) return {};
    const bool last = state.log_rows++ == kMaxLogRows;
    Status logged = last ? log(t_ns,
                               "warning",
                               name + " logged too many lines: the log has no further ones",
                               "",
                               name)
                         : log(t_ns, level_of(line), line.substr(0, kMaxLogBytes), "", name);
    if (!logged) return logged;
  }
  return {};
}

Status RunRecorder::add_answer(std::size_t estimator, EstimatorEvent& event) {
  EstimatorState& state = estimators_[estimator];
  EstimateRow row;
  row.sample = event.record.sample;
  row.latency_ms = event.latency_ms;
  row.dropped_frames = state.status.dropped;
  row.unanswered_frames = state.status.unanswered;
  const CameraRecords& camera = records_.camera_of(records_.estimators[estimator]);
  if (const FrameRow* frame = frame_row(camera, row.sample.frame)) {
    row.T_world_body = state.alignment.add(row.sample, {camera.frames.data(), frame + 1});
    if (const auto& S_world_vo = state.alignment.S_world_vo()) row.scale = S_world_vo->scale;
  }
  // An estimator that has ended returns an empty answer at once.
  if (state.status.crash.empty()) {
    state.frames.push_back(row.sample.frame);
    state.latency.ms.push_back(event.latency_ms);
    state.latency_so_far.add(event.latency_ms);
  }
  for (const auto& [stage, ms] : event.timing_ms) state.stages[stage].ms.push_back(ms);
  timeline_->append_estimate(estimator, std::move(row), event.record.counters);
  if (Status status = keep_debug_image(estimator, event); !status) return status;
  if (Status status = keep_map_points(estimator, event); !status) return status;
  return log_transition(estimator, event.record);
}

Status RunRecorder::keep_debug_image(std::size_t estimator, EstimatorEvent& event) {
  if (!event.debug_image) return {};
  const EstimateSample& sample = event.record.sample;
  auto image = std::make_shared<const Image>(std::move(*event.debug_image));
  if (publish_images_) timeline_->set_live_debug(estimator, {sample.frame, sample.t_ns, image});
  const fs::path file = debug_image_file(folder_, info_.estimators[estimator], sample.frame);
  const auto bytes = encode_jpeg(*image, kDebugQuality);
  return bytes ? write_whole(file, *bytes) : Status(bytes.error());
}

Status RunRecorder::keep_map_points(std::size_t estimator, EstimatorEvent& event) {
  const auto& S_world_vo = estimators_[estimator].alignment.S_world_vo();
  if (event.map_points_vo.empty() || !S_world_vo) return {};
  const MapPoints points{*S_world_vo, std::move(event.map_points_vo)};
  if (publish_images_) timeline_->set_live_points(estimator, in_world(points, points.S_world_vo));
  const std::int64_t frame = event.record.sample.frame;
  return write_whole(map_points_file(folder_, info_.estimators[estimator], frame),
                     bytes_of(points));
}

Status RunRecorder::log_transition(std::size_t estimator, const EstimateRecord& record) {
  EstimatorState& state = estimators_[estimator];
  const EstimateSample& sample = record.sample;
  const std::string& name = info_.estimators[estimator];
  if (!record.crash.empty()) {
    const char* const what = record.hung ? " timed out: " : " crashed: ";
    return log(sample.t_ns, "error", name + what + record.crash);
  }
  if (!state.status.crash.empty()) return {};
  const TrackingState last = std::exchange(state.last, sample.state);
  const int last_map_id = std::exchange(state.last_map_id, sample.map_id);
  const bool first_map = state.maps.empty();
  const bool new_map = state.maps.insert(sample.map_id).second;
  if (!first_map && new_map) {
    return log(sample.t_ns, "warning", name + " started a new map: origin and scale are new");
  }
  if (!first_map && sample.map_id != last_map_id) {
    return log(sample.t_ns,
               "info",
               name + " recovered map " + std::to_string(sample.map_id) + " and tracks");
  }
  if (sample.state == last) return {};
  const bool lost = sample.state == TrackingState::kLost;
  return log(sample.t_ns,
             lost ? "warning" : "info",
             name + (lost                                       ? " lost track"
                     : sample.state == TrackingState::kTracking ? " tracks"
                                                                : " initialises"));
}

Status RunRecorder::write_timings(Json timings) const {
  timings["peak_memory_mb"] = peak_memory_mb();
  Json estimators = Json::object();
  for (std::size_t i = 0; i < estimators_.size(); ++i) {
    const EstimatorState& state = estimators_[i];
    Json stages = Json::object();
    for (const auto& [stage, durations] : state.stages) stages[stage] = durations.summary();
    estimators[info_.estimators[i]] = {{"latency", state.latency.summary()},
                                       {"stages", std::move(stages)},
                                       {"resources", use_json(state.status)},
                                       {"frame", state.frames},
                                       {"latency_ms", state.latency.ms}};
  }
  timings["estimators"] = std::move(estimators);
  return write_json(timings_file(folder_), timings);
}

}  // namespace overfly::server
