#include "server/run/run_recorder.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "server/files/build_info.hpp"
#include "server/files/jpeg.hpp"
#include "server/files/png_file.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_lock.hpp"
#include "server/record/run_timeline.hpp"
#include "server/run/run_calibration.hpp"
#include "server/scoring/metrics.hpp"

namespace overfly::engine {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Close to lossless: estimators may be run again on these images.
constexpr int kFrameQuality = 95;

Status make_empty_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) return Error{ErrorCode::kIo, folder.string() + ": " + failure.message()};
  if (fs::exists(fs::symlink_status(manifest_file(folder), failure))) {
    return Error{ErrorCode::kConflict, folder.string() + ": already contains a run"};
  }
  if (!fs::is_empty(folder, failure) || failure) {
    return Error{ErrorCode::kConflict, folder.string() + ": is not empty"};
  }
  return {};
}

Json estimators_json(const Scenario& scenario) {
  Json estimators = Json::array();
  for (const EstimatorSpec& spec : scenario.estimators) {
    estimators.push_back({{"name", spec.name},
                          {"type", spec.type},
                          {"camera", scenario.cameras[spec.camera].name},
                          {"test_estimator", is_test_estimator(spec.type)}});
  }
  return estimators;
}

Json camera_json(const CameraSpec& spec, const FrameRate& rate) {
  Json entry = json_from(spec.model);
  entry["name"] = spec.name;
  entry["rate_hz"] = rate.hz();
  entry["T_body_camera"] = json_from(spec.T_body_camera);
  entry["color"] = spec.rgb ? "rgb" : "grey";
  entry["bits"] = spec.sensor.bits;
  entry["sensor"] = spec.sensor.enabled;
  if (!spec.sensor.enabled) return entry;
  entry["readout_ns"] = ns_from_s(spec.sensor.readout_s);
  entry["gain_dn_per_e"] = spec.sensor.effective_gain_dn_per_e();
  entry["adc_bits"] = spec.sensor.effective_adc_bits();
  return entry;
}

Status write_jpeg(const fs::path& file, const Image& image, int quality) {
  const auto bytes = encode_jpeg(image, quality);
  if (!bytes) return bytes.error();
  return write_whole(file, *bytes);
}

}  // namespace

RunRecorder::RunRecorder(fs::path folder, RunLock lock, const Scenario& scenario)
    : folder_(std::move(folder)), lock_(std::move(lock)), scenario_(scenario) {}

Result<std::unique_ptr<RunRecorder>> RunRecorder::create(const fs::path& folder,
                                                         const Scenario& scenario,
                                                         std::shared_ptr<RunTimeline> timeline,
                                                         bool publish_images) {
  if (Status status = make_empty_folder(folder); !status) return status.error();
  Result<RunLock> lock = RunLock::take(folder);
  if (!lock) return lock.error();
  // Another process may have used the folder between the check and the lock.
  std::error_code ignored;
  if (fs::exists(manifest_file(folder), ignored)) {
    return Error{ErrorCode::kConflict, folder.string() + ": already contains a run"};
  }
  std::unique_ptr<RunRecorder> recorder(new RunRecorder(folder, std::move(lock).value(), scenario));
  RunInfo& info = recorder->info_;
  if (timeline) info = timeline->info();
  info.id = folder_name(folder);
  info.scenario = scenario.name;
  info.title = scenario.title;
  info.pacing = to_string(scenario.pacing);
  info.status = RunStatus::kRunning;
  info.estimators.clear();
  info.estimator_cameras.clear();
  for (const EstimatorSpec& spec : scenario.estimators) {
    info.estimators.push_back(spec.name);
    info.estimator_cameras.push_back(scenario.cameras[spec.camera].name);
    recorder->records_.estimators.push_back({spec.name, spec.type, {}, spec.camera});
  }
  info.cameras.clear();
  for (const CameraSpec& camera : scenario.cameras) {
    info.cameras.push_back(camera.name);
    if (info.cameras.size() == 1) {
      recorder->records_.T_body_camera = camera.T_body_camera;
    } else {
      recorder->records_.other_cameras.push_back({camera.name, camera.T_body_camera, {}});
    }
  }
  if (info.created_utc.empty()) info.created_utc = utc_text(utc_now_ns());
  if (!timeline) timeline = std::make_shared<RunTimeline>(info, info.estimators);
  recorder->timeline_ = std::move(timeline);
  recorder->publish_images_ = publish_images;
  if (Status status = recorder->open_files(); !status) return status.error();
  return recorder;
}

Status RunRecorder::open_files() {
  manifest_ = {{"format_version", kRunFormatVersion},
               {"version", version()},
               {"commit", git_commit()},
               {"seed", scenario_.seed},
               {"world", Json::object()},
               {"estimators", estimators_json(scenario_)}};
  // A manifest makes the folder a run, so the other files that a list of runs reads are written
  // before it.
  if (Status status = write_json(created_file(folder_), {{"created_utc", info_.created_utc}});
      !status) {
    return status;
  }
  if (Status status = write_timings(Json::object()); !status) return status;
  if (Status status = write_manifest(); !status) return status;
  if (Status status = write_json(scenario_file(folder_), scenario_.resolved); !status) {
    return status;
  }
  std::error_code failure;
  fs::create_directories(folder_ / "estimates", failure);
  if (Status status = open_camera_files(); !status) return status;
  Result<LineFile> log = LineFile::create(log_file(folder_));
  if (!log) return log.error();
  log_lines_ = std::move(log).value();
  for (const std::string& name : info_.estimators) {
    Result<LineFile> lines = LineFile::create(estimate_file(folder_, name));
    if (!lines) return lines.error();
    const std::size_t camera = records_.estimators[estimators_.size()].camera;
    estimators_.push_back({std::move(lines).value(), LiveAlignment(records_.mount_of(camera))});
    if (scenario_.record_debug_hz > 0.0) fs::create_directories(folder_ / "debug" / name, failure);
  }
  if (failure) return Error{ErrorCode::kIo, folder_.string() + ": " + failure.message()};
  timeline_->set_info(info_);
  return {};
}

Status RunRecorder::open_camera_files() {
  std::error_code failure;
  const bool several = info_.cameras.size() > 1;
  if (several) fs::create_directories(folder_ / "cameras", failure);
  for (std::size_t i = 0; i < info_.cameras.size(); ++i) {
    const std::string& name = info_.cameras[i];
    const std::string of = i == 0 ? "" : name;
    if (scenario_.record_frames) {
      fs::create_directories(frame_image_file(folder_, of, 0).parent_path(), failure);
      if (!failure && scenario_.cameras[i].sensor.bits > 8) {
        fs::create_directories(deep_frame_file(folder_, of, 0).parent_path(), failure);
      }
    }
    if (failure) return Error{ErrorCode::kIo, folder_.string() + ": " + failure.message()};
    Result<LineFile> lines =
        LineFile::create(i == 0 ? frames_file(folder_) : camera_frames_file(folder_, name));
    if (!lines) return lines.error();
    frame_lines_.push_back(std::move(lines).value());
  }
  return {};
}

Status RunRecorder::write_manifest() {
  put_run_info(info_, manifest_);
  timeline_->set_info(info_);
  return write_json(manifest_file(folder_), manifest_);
}

Status RunRecorder::set_cameras() {
  std::vector<RunCamera> cameras;
  cameras.reserve(scenario_.cameras.size());
  Json entries = Json::array();
  for (const CameraSpec& spec : scenario_.cameras) {
    cameras.push_back({spec.name, spec.model, spec.T_body_camera});
    entries.push_back(camera_json(spec, scenario_.rate));
    if (Status status = write_calibration(folder_, spec); !status) return status;
  }
  const CameraSpec& main = scenario_.cameras.front();
  manifest_["camera"] = json_from(main.model.pinhole());
  manifest_["camera"]["rate_hz"] = scenario_.rate.hz();
  manifest_["camera"]["T_body_camera"] = json_from(main.T_body_camera);
  manifest_["cameras"] = std::move(entries);
  timeline_->set_cameras(std::move(cameras));
  return {};
}

void RunRecorder::set_length(std::int64_t duration_ns, std::int64_t frames_total) {
  info_.duration_ns = duration_ns;
  info_.frames_total = frames_total;
}

void RunRecorder::set_attribution(const std::string& attribution) {
  info_.attribution = attribution;
}

Status RunRecorder::add_frame(const FrameRecord& record,
                              const std::shared_ptr<const Image>& image,
                              const Image16& deep,
                              std::size_t camera) {
  const std::int64_t frame = record.row.frame;
  if (Status status = frame_lines_[camera].append(json_from(record)); !status) return status;
  std::vector<FrameRecord>& frames =
      camera == 0 ? records_.frames : records_.other_cameras[camera - 1].frames;
  frames.push_back(record);
  timeline_->append_frame(record.row, camera);
  if (publish_images_ && image) timeline_->set_live_camera({frame, record.row.t_ns, image}, camera);
  if (scenario_.record_frames && image) {
    if (Status status = keep_image(frame, *image, deep, camera); !status) return status;
  }
  if (camera != 0) return {};
  ++info_.frames;
  timeline_->set_info(info_);
  return {};
}

Status RunRecorder::keep_image(std::int64_t frame,
                               const Image& image,
                               const Image16& deep,
                               std::size_t camera) {
  const std::string of = camera == 0 ? "" : scenario_.cameras[camera].name;
  if (Status status = write_jpeg(frame_image_file(folder_, of, frame), image, kFrameQuality);
      !status) {
    return status;
  }
  return deep.empty() ? Status() : write_png_file(deep_frame_file(folder_, of, frame), deep);
}

Status RunRecorder::add_late_frame(std::int64_t frame, std::int64_t t_ns) {
  records_.late_frames.push_back({frame, t_ns});
  return frame_lines_.front().append({{"frame", frame}, {"t_ns", t_ns}, {"late", true}});
}

Status RunRecorder::log(std::int64_t t_ns,
                        const std::string& level,
                        const std::string& text,
                        const std::string& kind,
                        const std::string& source) {
  const LogRow row{t_ns, level, text, kind, source};
  timeline_->append_log(row);
  return log_lines_->append(json_from(row));
}

Result<Json> RunRecorder::finish(RunStatus status, const std::string& error, Json timings) {
  info_.status = status;
  info_.error = error;
  Result<Json> metrics = write_derived(folder_, records_);
  for (std::size_t i = 0; i < scenario_.cameras.size() && metrics; ++i) {
    const Status kept = write_times(folder_, scenario_.cameras[i], records_.frames_of(i));
    if (!kept) metrics = kept.error();
  }
  info_.texture_limited = metrics && is_texture_limited(*metrics);
  if (!metrics) {
    info_.status = RunStatus::kFailed;
    if (info_.error.empty()) info_.error = metrics.error().message;
  } else {
    timeline_->set_metrics(*metrics);
  }
  timings["viewers"] = timeline_->audience()->summary();
  const Status timed = write_timings(std::move(timings));
  const Status written = let_go();
  if (!metrics) return metrics.error();
  if (!timed) return timed.error();
  if (!written) return written.error();
  return metrics;
}

Status RunRecorder::let_go() {
  put_run_info(info_, manifest_);
  Status written = write_json(manifest_file(folder_), manifest_);
  // Before the end of the run is announced, since others may change the file from then on.
  timeline_->set_manifest_stamp(FileStamp::of(manifest_file(folder_)));
  // A client that learns of the run's end may delete it at once; the lock is therefore released
  // first.
  lock_.reset();
  timeline_->set_info(info_);
  return written;
}

void RunRecorder::give_up(const Error& error) {
  if (!lock_) return;
  info_.status = RunStatus::kFailed;
  info_.error = error.message;
  try {
    (void)let_go();
  } catch (const std::exception&) {
    // Out of memory even for the manifest: without its lock the run is shown as interrupted.
    lock_.reset();
  }
}

}  // namespace overfly::engine
