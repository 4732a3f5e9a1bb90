#include "server/run/run_recorder.hpp"

#include <algorithm>
#include <exception>
#include <set>
#include <utility>

#include "server/files/build_info.hpp"
#include "server/files/file_stamp.hpp"
#include "server/files/jpeg.hpp"
#include "server/files/png_file.hpp"
#include "server/record/rows/vehicle_rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_lock.hpp"
#include "server/record/run_manifest.hpp"
#include "server/run/run_calibration.hpp"
#include "server/scoring/metrics.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Close to lossless: estimators may be run again on these images.
constexpr int kFrameQuality = 95;

/// Whether a folder contains only a run that failed before its first frame: nothing is to be kept.
bool failed_at_start(const fs::path& folder) {
  const std::set<fs::path> of_a_run = {manifest_file(folder),
                                       scenario_file(folder),
                                       created_file(folder),
                                       timings_file(folder),
                                       metrics_file(folder),
                                       log_file(folder),
                                       vehicle_file(folder),
                                       truth_samples_file(folder),
                                       CameraFiles::of_main_camera(folder).rows(),
                                       CameraFiles::of_main_camera(folder).truth(),
                                       folder / "cameras",
                                       folder / "frames",
                                       folder / "frames16",
                                       folder / "debug",
                                       folder / "points",
                                       folder / "estimates",
                                       folder / "estimators",
                                       RunLock::file_of(folder)};
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure)) {
    if (!of_a_run.contains(entry.path())) return false;
  }
  const Result<RunInfo> info = read_run_info(folder);
  return !failure && info && info->problem.empty() && info->status == RunStatus::kFailed &&
         info->frames == 0;
}

/// Creates the folder unless it is empty, or contains only a run that failed at its start.
Status make_free_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) return Error{ErrorCode::kIo, folder.string() + ": " + failure.message()};
  if (fs::exists(fs::symlink_status(manifest_file(folder), failure))) {
    if (failed_at_start(folder)) return {};
    return Error{ErrorCode::kConflict, folder.string() + ": already contains a run"};
  }
  if (!fs::is_empty(folder, failure) || failure) {
    return Error{ErrorCode::kConflict, folder.string() + ": is not empty"};
  }
  return {};
}

/// Of a run that could not begin. Its lock stays.
void remove_contents(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(manifest_file(folder), ignored);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path() != RunLock::file_of(folder)) fs::remove_all(entry.path(), ignored);
  }
}

std::vector<RunManifest::Estimator> listed_estimators(const Scenario& scenario) {
  std::vector<RunManifest::Estimator> estimators;
  for (const EstimatorSpec& spec : scenario.estimators) {
    RunManifest::Estimator& estimator = estimators.emplace_back();
    estimator.name = spec.name;
    estimator.type = spec.type;
    estimator.camera = scenario.cameras[spec.camera].name;
    estimator.test_estimator = is_test_estimator(spec.type);
  }
  return estimators;
}

RunManifest::Camera listed_camera(const CameraSpec& spec, const FrameRate& rate) {
  RunManifest::Camera camera;
  camera.name = spec.name;
  camera.model = spec.model;
  camera.rate_hz = rate.hz();
  camera.T_body_camera = spec.T_body_camera;
  camera.rgb = spec.rgb;
  camera.bits = spec.sensor.bits;
  if (!spec.sensor.enabled) return camera;
  camera.sensor = RunManifest::Sensor{ns_from_s(spec.sensor.readout_s),
                                      spec.sensor.effective_gain_dn_per_e(),
                                      spec.sensor.effective_adc_bits()};
  return camera;
}

Status write_jpeg(const fs::path& file, const Image& image, int quality) {
  const auto bytes = encode_jpeg(image, quality);
  if (!bytes) return bytes.error();
  return write_whole(file, *bytes);
}

}  // namespace

RunRecorder::RunRecorder(fs::path folder, RunLock lock, const Scenario& scenario)
    : folder_(std::move(folder)),
      lock_(std::move(lock)),
      scenario_(scenario),
      sensor_files_(folder_) {}

Result<std::unique_ptr<RunRecorder>> RunRecorder::create(const fs::path& folder,
                                                         const Scenario& scenario,
                                                         std::shared_ptr<RunTimeline> timeline,
                                                         bool publish_images) {
  const FileStamp checked = FileStamp::of(manifest_file(folder));
  if (Status status = make_free_folder(folder); !status) return status.error();
  Result<RunLock> lock = RunLock::take(folder);
  if (!lock) return lock.error();
  // Another process may have used the folder between the check and the lock.
  if (FileStamp::of(manifest_file(folder)) != checked) {
    return Error{ErrorCode::kConflict, folder.string() + ": already contains a run"};
  }
  if (checked.exists) remove_contents(folder);
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
  recorder->records_.cameras.clear();
  for (const CameraSpec& camera : scenario.cameras) {
    info.cameras.push_back(camera.name);
    recorder->records_.cameras.push_back({camera.name, camera.T_body_camera, {}});
  }
  if (info.created_utc.empty()) info.created_utc = utc_text(utc_now_ns());
  if (!timeline) timeline = std::make_shared<RunTimeline>(info, info.estimators);
  recorder->timeline_ = std::move(timeline);
  recorder->publish_images_ = publish_images;
  if (Status status = recorder->open_files(); !status) {
    recorder.reset();  // closes its files: the reason may be that too many are open
    remove_contents(folder);
    return status.error();
  }
  return recorder;
}

Status RunRecorder::open_files() {
  lock_->keep_room();
  manifest_.version = version();
  manifest_.commit = git_commit();
  manifest_.seed = scenario_.seed;
  manifest_.estimators = listed_estimators(scenario_);
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
  const CameraSpec* const recorded = scenario_.recorded_camera();
  if (recorded != nullptr && recorded->images->compare_with) {
    Result<LineFile> agreement = LineFile::create(agreement_file(folder_));
    if (!agreement) return agreement.error();
    agreement_lines_ = std::move(agreement).value();
  }
  Result<TruthSampleFile> samples = TruthSampleFile::create(truth_samples_file(folder_));
  if (!samples) return samples.error();
  truth_samples_ = std::move(samples).value();
  for (const std::string& name : info_.estimators) {
    Result<LineFile> lines = LineFile::create(estimate_file(folder_, name));
    if (!lines) return lines.error();
    const CameraRecords& camera = records_.camera_of(records_.estimators[estimators_.size()]);
    estimators_.push_back({std::move(lines).value(), LiveAlignment(camera.T_body_camera)});
    if (scenario_.record_debug_hz > 0.0) {
      fs::create_directories(folder_ / "debug" / name, failure);
      if (!failure) fs::create_directories(folder_ / "points" / name, failure);
    }
    if (failure) break;
  }
  if (failure) return Error{ErrorCode::kIo, folder_.string() + ": " + failure.message()};
  timeline_->set_info(info_);
  return {};
}

Status RunRecorder::open_camera_files() {
  std::error_code failure;
  for (std::size_t i = 0; i < info_.cameras.size(); ++i) {
    const CameraFiles files(folder_, i, info_.cameras[i]);
    fs::create_directories(files.rows().parent_path(), failure);
    if (!failure && scenario_.record_frames) {
      fs::create_directories(files.image(0).parent_path(), failure);
      if (!failure && scenario_.cameras[i].sensor.bits > 8) {
        fs::create_directories(files.deep_image(0).parent_path(), failure);
      }
    }
    if (failure) return Error{ErrorCode::kIo, folder_.string() + ": " + failure.message()};
    Result<LineFile> lines = LineFile::create(files.rows());
    if (!lines) return lines.error();
    frame_lines_.push_back(std::move(lines).value());
  }
  return {};
}

Status RunRecorder::write_manifest() {
  put_run_info(info_, manifest_);
  put_description(manifest_, &info_);
  timeline_->set_info(info_);
  return write_json(manifest_file(folder_), json_from(manifest_));
}

Status RunRecorder::set_cameras(
    const std::vector<std::optional<CalibratedIntrinsics>>& calibrated) {
  std::vector<RunCamera> cameras;
  cameras.reserve(scenario_.cameras.size());
  for (const CameraSpec& spec : scenario_.cameras) {
    RunManifest::Camera& listed =
        manifest_.cameras.emplace_back(listed_camera(spec, scenario_.rate));
    listed.calibrated = calibrated.at(cameras.size());
    cameras.push_back({spec.name, spec.model, spec.T_body_camera});
    if (Status status = write_calibration(folder_, spec); !status) return status;
  }
  timeline_->set_cameras(std::move(cameras));
  return {};
}

void RunRecorder::set_length(std::int64_t duration_ns, std::int64_t frames_total) {
  info_.duration_ns = duration_ns;
  info_.frames_total = frames_total;
}

Status RunRecorder::add_frame(FrameRow row,
                              const std::shared_ptr<const Image>& image,
                              const Image16& deep,
                              std::size_t camera) {
  const std::int64_t frame = row.frame;
  // Lines of late frames are those of the main camera.
  if (camera == kMainCamera) {
    row.late_frames = static_cast<std::int64_t>(records_.late_frames.size());
  }
  if (Status status = frame_lines_[camera].append(json_from(row)); !status) return status;
  records_.cameras[camera].frames.push_back(row);
  timeline_->append_frame(row, camera);
  if (publish_images_ && image) timeline_->set_live_camera({frame, row.t_ns, image}, camera);
  if (scenario_.record_frames && image) {
    if (Status status = keep_image(frame, *image, deep, camera); !status) return status;
  }
  info_.frames = static_cast<std::int64_t>(records_.main_camera().frames.size());
  timeline_->set_info(info_);
  return {};
}

Status RunRecorder::keep_image(std::int64_t frame,
                               const Image& image,
                               const Image16& deep,
                               std::size_t camera) {
  const CameraFiles files(folder_, camera, info_.cameras[camera]);
  if (Status status = write_jpeg(files.image(frame), image, kFrameQuality); !status) return status;
  return deep.empty() ? Status() : write_png_file(files.deep_image(frame), deep);
}

Status RunRecorder::add_agreement(const AgreementRow& row) {
  return agreement_lines_->append(json_from(row));
}

Status RunRecorder::add_late_frame(std::int64_t frame, std::int64_t t_ns) {
  records_.late_frames.push_back({frame, t_ns});
  return frame_lines_.at(kMainCamera).append({{"frame", frame}, {"t_ns", t_ns}, {"late", true}});
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

Status RunRecorder::add_vehicle_status(const VehicleStatus& status) {
  if (!vehicle_lines_) {
    Result<LineFile> lines = LineFile::create(vehicle_file(folder_));
    if (!lines) return lines.error();
    vehicle_lines_ = std::move(lines).value();
  }
  timeline_->append_vehicle_status(status);
  return vehicle_lines_->append(json_from(status));
}

Result<RunMetrics> RunRecorder::finish(RunStatus status, const std::string& error, Json timings) {
  info_.status = status;
  info_.error = error;
  Result<RunMetrics> metrics = write_derived(folder_, records_);
  for (std::size_t i = 0; i < scenario_.cameras.size() && metrics; ++i) {
    const Status kept = write_times(folder_, scenario_.cameras[i], records_.cameras[i].frames);
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
  lock_->free_room();
  Status written = write_json(manifest_file(folder_), json_from(manifest_));
  // Before the end of the run is announced, since others may change the file from then on.
  timeline_->set_manifest_stamp(FileStamp::of(manifest_file(folder_)));
  if (!written && info_.status == RunStatus::kCompleted) {
    info_.status = RunStatus::kFailed;
    info_.error = written.error().message;
  }
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

}  // namespace overfly::server
