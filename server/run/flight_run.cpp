#include "server/run/flight_run.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/cancel.hpp"
#include "core/measure/crc32.hpp"
#include "server/record/rows/rows.hpp"
#include "server/run/frames_ahead.hpp"
#include "server/timing/picture_rate.hpp"
#include "server/timing/thread_priority.hpp"

namespace overfly::server {
namespace {

Error stopped() { return {ErrorCode::kCancelled, "cancelled"}; }

FrameRow row_from(const MadeFrame& made, const CameraShot& shot, const CameraSpec& camera) {
  FrameRow row;
  row.frame = made.frame;
  row.t_ns = made.t_ns;
  row.T_world_camera = shot.drawn.T_world_camera;
  row.shaken = camera.vibration.enabled;
  row.T_world_body = row.shaken ? made.state.T_world_body
                                : shot.drawn.T_world_camera * camera.T_body_camera.inverse();
  row.texels_per_pixel_median = shot.drawn.texels_per_pixel_median;
  row.texels_per_pixel_min = shot.drawn.texels_per_pixel_min;
  row.void_fraction = shot.drawn.void_fraction;
  row.exposure_ns = shot.setting.exposure_ns;
  row.gain = shot.setting.gain;
  row.saturated_fraction = shot.saturated_fraction;
  row.late_tiles = shot.drawn.late_tiles;
  row.stamp_offset_ns = shot.stamp_ns - made.t_ns;
  row.faults = shot.faults;
  row.axis_depth_m = shot.drawn.axis_depth_m;
  row.source_image = shot.source_image;
  return row;
}

VoFrame vo_frame_from(const MadeFrame& made,
                      const CameraShot& shot,
                      const std::string& camera,
                      const CameraModel& model,
                      std::shared_ptr<const Image> grey) {
  VoFrame frame;
  frame.camera_id = camera;
  frame.index = made.frame;
  frame.t_ns = shot.stamp_ns;
  frame.exposure_ns = shot.setting.exposure_ns;
  frame.image = std::move(grey);
  frame.intrinsics = model.pinhole();
  frame.distortion = model.distortion();
  return frame;
}

}  // namespace

FlightRun::FlightRun(const Scenario& scenario, const RunOptions& options, RunRecorder& recorder)
    : scenario_(scenario),
      options_(options),
      recorder_(recorder),
      clock_(options.clock != nullptr ? *options.clock : machine_clock()),
      stages_(clock_),
      begin_ns_(clock_.now_ns()),
      fault_news_(scenario),
      saturation_(scenario),
      truth_feeds_(scenario.cameras.size()) {}

bool FlightRun::cancelled() const { return is_cancelled(options_.cancel); }

std::int64_t FlightRun::end_ns() const {
  const std::vector<FrameRow>& frames = recorder_.records().main_camera().frames;
  return frames.empty() ? 0 : frames.back().t_ns;
}

nlohmann::json FlightRun::timings() const {
  const std::int64_t now_ns = clock_.now_ns();
  // Excludes the set-up: making or opening the world is not part of a frame's cost.
  const double loop_s = loop_begin_ns_ == 0 ? 0.0 : s_from_ns(now_ns - loop_begin_ns_);
  const double flight_s = s_from_ns(end_ns());
  nlohmann::json timings = {{"finished_utc", utc_text(utc_now_ns())},
                            {"wall_s", s_from_ns(now_ns - begin_ns_)},
                            {"loop_wall_s", loop_s},
                            {"flight_s", flight_s},
                            {"flight_s_per_wall_s", loop_s > 0.0 ? flight_s / loop_s : 0.0},
                            {"late_tiles", late_tiles_},
                            {"frames_with_late_tiles", frames_with_late_tiles_},
                            {"stages", stages_.summary()}};
  if (frame_cache_) timings["frame_cache"] = json_from(frame_cache_->use());
  if (!message_to_frame_.ms.empty()) timings["message_to_frame"] = message_to_frame_.summary();
  return timings;
}

Status FlightRun::fly() {
  // Before the cameras and the estimators start their threads, which inherit the priority.
  std::optional<RaisedThread> before_other_programs;
  if (scenario_.pacing == Pacing::kRealTime) before_other_programs.emplace();
  // Runs however the flight ends: output of an estimator that shuts down must be recorded while the
  // folder is still open.
  struct Leaving {
    FlightRun& run;
    ~Leaving() {
      run.workers_.clear();
      run.maker_.reset();
      if (run.frame_cache_) run.frame_cache_->finish();
    }
  } const leaving{*this};
  const Status flown = prepare_and_fly();
  const Status described = describe_end();
  const Status closed = close_estimators();
  if (!flown) return flown;
  return closed ? described : closed;
}

Status FlightRun::describe_end() {
  for (const std::string& line : saturation_.report()) {
    if (Status status = recorder_.log(end_ns(), "warning", line); !status) return status;
  }
  if (!maker_ || !recorder_.manifest().flight) return {};
  std::vector<std::string>& known = recorder_.manifest().flight->warnings;
  for (const std::string& warning : maker_->flight_warnings()) {
    if (std::find(known.begin(), known.end(), warning) != known.end()) continue;
    known.push_back(warning);
    if (Status status = recorder_.log(end_ns(), "warning", warning); !status) return status;
  }
  const std::string sensors = maker_->sensor_report();
  return sensors.empty() ? Status() : recorder_.log(end_ns(), "info", sensors);
}

Status FlightRun::prepare_and_fly() {
  using Step = Status (FlightRun::*)();
  const Step steps[] = {&FlightRun::calibrate_cameras,
                        &FlightRun::open_maker,
                        &FlightRun::open_estimators,
                        &FlightRun::describe};
  for (const Step& step : steps) {
    if (cancelled()) return stopped();
    if (Status status = (this->*step)(); !status) return status;
  }
  loop_begin_ns_ = clock_.now_ns();
  const Status flown = scenario_.pacing == Pacing::kRealTime ? fly_real_time() : fly_lockstep();
  return flown ? record_last_period() : flown;
}

Status FlightRun::record_last_period() {
  // Events behind the last frame of a flight whose end is known.
  if (maker_->duration_ns()) {
    Status logged = log_flight(maker_->frame_ns(maker_->frames_total()), end_ns());
    if (!logged) return logged;
  }
  const Result<SensorSamples> last = maker_->record_last_period();
  return last ? recorder_.add_sensor_samples(*last) : last.error();
}

std::int64_t FlightRun::last_recorded_frame() const {
  const std::vector<FrameRow>& frames = recorder_.records().main_camera().frames;
  return frames.empty() ? kNoFrame : frames.back().frame;
}

Status FlightRun::fly_lockstep() {
  // The lines of their start, before frames are on their way to them.
  if (Status status = record_events(kNoFrame); !status) return status;
  // An answer that is sent to the vehicle may change its flight.
  const std::size_t most = feedback_ ? 0 : lockstep_frames_ahead(scenario_);
  std::deque<Pending> pending;
  for (std::int64_t k = 0; k < maker_->frames_total(); ++k) {
    if (cancelled()) return stopped();
    std::exception_ptr thrown;
    Result<std::optional<Pending>> made = std::optional<Pending>();
    try {
      made = make_frame(k);
    } catch (...) {
      thrown = std::current_exception();
    }
    if (!made || !*made) {
      if (cancelled()) return made ? stopped() : made.error();
      // The frames before it have been flown.
      if (Status recorded = record_pending(pending, 0); !recorded) return recorded;
      if (thrown) std::rethrow_exception(thrown);
      const Status logged = log_end_of_flight();
      return made ? logged : made.error();
    }
    send(pending.emplace_back(std::move(**made)));
    if (Status recorded = record_pending(pending, most); !recorded) return recorded;
  }
  return record_pending(pending, 0);
}

Status FlightRun::record_pending(std::deque<Pending>& pending, std::size_t most) {
  while (!pending.empty()) {
    const std::int64_t previous = pending.front().made.frame - 1;
    const bool answered = std::all_of(workers_.begin(), workers_.end(), [&](const auto& worker) {
      return worker->answered(previous);
    });
    if (!answered && pending.size() <= most) return {};
    stages_.measure("wait_for_estimators", [&] {
      for (auto& worker : workers_) worker->wait_until_answered(previous);
      return 0;
    });
    if (cancelled()) return stopped();
    if (Status status = record_events(previous); !status) return status;
    const Status recorded = record(pending.front());
    if (options_.progress) options_.progress(recorder_.info());
    if (!recorded) return recorded;
    pending.pop_front();
  }
  return {};
}

Status FlightRun::fly_real_time() {
  Status fetched = stages_.measure("fetch_first_view", [&] { return maker_->fetch_first_view(); });
  if (!fetched) return fetched;
  PictureRate nobody_asks;
  PictureRate& pictures = options_.picture_rate != nullptr ? *options_.picture_rate : nobody_asks;
  loop_begin_ns_ = clock_.now_ns();
  // Also if an exception is thrown: viewers must not be throttled for a flight that is over.
  struct InTheAir {
    RunClock& clock;
    PictureRate& pictures;
    InTheAir(RunClock& by, PictureRate& beside) : clock(by), pictures(beside) {
      clock.enter();
      pictures.flight_began(clock.now_ns());
    }
    ~InTheAir() {
      pictures.flight_ended();
      clock.leave();
    }
    InTheAir(const InTheAir&) = delete;
    InTheAir& operator=(const InTheAir&) = delete;
  } const in_the_air(clock_, pictures);
  maker_->begin_flight();
  // t = 0 is now, after all that takes time.
  recorder_.manifest().epoch_utc_ns = epoch_utc_ns();
  // A live flight states at which time of the vehicle's clock it begins.
  if (auto& flight = recorder_.manifest().flight)
    flight->description = maker_->flight_description();
  if (Status written = recorder_.write_manifest(); !written) return written;
  std::int64_t start_ns = clock_.now_ns();
  // A live flight's first state came a moment ago: the camera must not be late by that.
  const std::optional<std::int64_t> heard_ns = maker_->heard_ns();
  if (heard_ns && &clock_ == &machine_clock()) start_ns = std::min(start_ns, *heard_ns);
  return keep_pace(start_ns, pictures);
}

Status FlightRun::keep_pace(std::int64_t start_ns, PictureRate& pictures) {
  for (std::int64_t k = 0; k < maker_->frames_total(); ++k) {
    if (cancelled()) return stopped();
    const std::int64_t t_ns = maker_->frame_ns(k);
    const std::int64_t next_ns = maker_->frame_ns(k + 1);
    const std::int64_t now_ns = clock_.now_ns() - start_ns;
    if (now_ns >= next_ns) {
      // The next frame is already due: drawing this one would only delay it.
      if (Status recorded = recorder_.add_late_frame(k, t_ns); !recorded) return recorded;
      pictures.frame_missed(clock_.now_ns());
      continue;
    }
    const bool waited =
        now_ns >= t_ns || clock_.wait_until_ns(start_ns + t_ns, [this] { return cancelled(); });
    if (!waited) return stopped();
    Result<std::optional<Pending>> made = make_frame(k);
    if (!made || !*made) {
      if (!made) return made.error();
      return cancelled() ? stopped() : log_end_of_flight();
    }
    if (Status status = record_events(EstimatorWorker::kAllFrames); !status) return status;
    send(**made);
    const Status recorded = record(**made);
    if (options_.progress) options_.progress(recorder_.info());
    if (!recorded) return recorded;
    const std::int64_t done_ns = clock_.now_ns();
    pictures.frame_made(done_ns, next_ns - t_ns, start_ns + next_ns - done_ns);
  }
  return {};
}

Result<std::optional<FlightRun::Pending>> FlightRun::make_frame(std::int64_t k) {
  auto made = maker_->make(k);
  if (!made) return made.error();
  if (!*made) return std::optional<Pending>();
  if (const std::optional<std::int64_t> heard_ns = maker_->heard_ns()) {
    message_to_frame_.ms.push_back(static_cast<double>(machine_clock().now_ns() - *heard_ns) *
                                   1e-6);
  }
  Pending frame;
  frame.made = std::move(**made);
  frame.events = maker_->take_flight_events(frame.made.t_ns);
  frame.vehicle = maker_->take_vehicle_status(frame.made.t_ns);
  return std::optional(std::move(frame));
}

void FlightRun::send(Pending& frame) {
  MadeFrame& made = frame.made;
  unsent_samples_.resize(workers_.size());
  for (SensorSamples& unsent : unsent_samples_) {
    append(unsent, SensorSamples(made.sensors));
    drop_older_than(unsent, kOldestSampleNs);
  }
  for (CameraShot& shot : made.shots) {
    const auto& image =
        frame.images.emplace_back(std::make_shared<const Image>(std::move(shot.image)));
    std::optional<std::uint32_t>& crc32 = frame.image_crc32.emplace_back();
    if (const auto& feed = truth_feeds_[shot.camera]) {
      feed->add(shot.stamp_ns, {shot.drawn.T_world_camera, shot.drawn.axis_depth_m});
    }
    if (feedback_ && scenario_.estimators[*scenario_.feedback_estimator].camera == shot.camera) {
      feedback_->add_frame(row_from(made, shot, scenario_.cameras[shot.camera]));
    }
    if (!shot.delivered) continue;
    const auto grey = image->channels != 1 ? std::make_shared<const Image>(grey_of(*image)) : image;
    // Computed once per frame, so that it applies to the image of every estimator.
    crc32 = stages_.measure("hash", [&] { return crc32_of(*grey); });
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      if (scenario_.estimators[i].camera != shot.camera) continue;
      VoFrame sent = vo_frame_from(made, shot, shot.name, given_model(shot.camera), grey);
      sent.image_crc32 = *crc32;
      sent.sensors = std::exchange(unsent_samples_[i], {});
      workers_[i]->submit(std::move(sent));
    }
  }
}

Status FlightRun::record(Pending& frame) {
  const MadeFrame& made = frame.made;
  if (Status status = log_faults(made.t_ns); !status) return status;
  Status logged = log_flight(frame.events, std::move(frame.vehicle), made.t_ns);
  if (!logged) return logged;
  if (!made.sensors.empty()) {
    const Status sensed =
        stages_.measure("sensors", [&] { return recorder_.add_sensor_samples(made.sensors); });
    if (!sensed) return sensed;
  }
  if (Status judged = judge_recorded_image(frame); !judged) return judged;
  for (std::size_t shot = 0; shot < made.shots.size(); ++shot) {
    if (Status recorded = record_shot(frame, shot); !recorded) return recorded;
  }
  return {};
}

Status FlightRun::record_shot(const Pending& frame, std::size_t index) {
  const CameraShot& shot = frame.made.shots[index];
  FrameRow row = row_from(frame.made, shot, scenario_.cameras[shot.camera]);
  row.image_crc32 = frame.image_crc32[index];
  const std::optional<std::string> overexposed =
      saturation_.add(shot.camera, row.frame, row.saturated_fraction, row.exposure_ns);
  if (overexposed) {
    if (Status status = recorder_.log(row.t_ns, "warning", *overexposed); !status) return status;
  }
  late_tiles_ += row.late_tiles;
  frames_with_late_tiles_ += row.late_tiles > 0 ? 1 : 0;
  const auto image = shot.delivered ? frame.images[index] : nullptr;
  return stages_.measure(
      "record", [&] { return recorder_.add_frame(row, image, shot.image16, shot.camera); });
}

}  // namespace overfly::server
