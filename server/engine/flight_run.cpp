#include "server/engine/flight_run.hpp"

#include <utility>

namespace overfly::engine {
namespace {

Error stopped() { return {ErrorCode::kCancelled, "cancelled"}; }

}  // namespace

FlightRun::FlightRun(const Scenario& scenario, const RunOptions& options, RunRecorder& recorder)
    : scenario_(scenario),
      options_(options),
      recorder_(recorder),
      clock_(options.clock != nullptr ? *options.clock : machine_clock()),
      stages_(clock_),
      begin_ns_(clock_.now_ns()) {}

bool FlightRun::cancelled() const { return options_.cancel != nullptr && options_.cancel->load(); }

std::int64_t FlightRun::end_ns() const {
  const std::vector<FrameRecord>& frames = recorder_.records().frames;
  return frames.empty() ? 0 : frames.back().row.t_ns;
}

nlohmann::json FlightRun::timings() const {
  const std::int64_t now_ns = clock_.now_ns();
  // Without the set-up: making or opening the world is no part of a frame's cost.
  const double loop_s = loop_begin_ns_ == 0 ? 0.0 : s_from_ns(now_ns - loop_begin_ns_);
  const double flight_s = s_from_ns(end_ns());
  return {{"finished_utc", utc_text(utc_now_ns())},
          {"wall_s", s_from_ns(now_ns - begin_ns_)},
          {"loop_wall_s", loop_s},
          {"flight_s", flight_s},
          {"flight_s_per_wall_s", loop_s > 0.0 ? flight_s / loop_s : 0.0},
          {"stages", stages_.summary()}};
}

Status FlightRun::fly() {
  using Step = Status (FlightRun::*)();
  const std::pair<const char*, Step> steps[] = {{"open_world", &FlightRun::open_world},
                                                {"plan_flight", &FlightRun::plan_flight},
                                                {"open_renderer", &FlightRun::open_renderer},
                                                {"open_estimators", &FlightRun::open_estimators},
                                                {"describe", &FlightRun::describe}};
  for (const auto& step : steps) {
    if (cancelled()) return stopped();
    Status status = stages_.measure(step.first, [&] { return (this->*step.second)(); });
    if (!status) return status;
  }
  loop_begin_ns_ = clock_.now_ns();
  Status flown = scenario_.pacing == Pacing::kRealTime ? fly_real_time() : fly_lockstep();
  // Also after an error: what the estimators have said so far belongs into the folder.
  stages_.measure("wait_for_estimators", [&] {
    for (auto& worker : workers_) worker->wait_until_idle();
    return 0;
  });
  Status recorded = record_events();
  renderer_.reset();
  return flown ? recorded : flown;
}

Status FlightRun::fly_lockstep() {
  for (std::int64_t k = 0; k < frames_total_; ++k) {
    if (cancelled()) return stopped();
    Status status = fly_frame(k, true);
    if (!status && status.error().code == ErrorCode::kNotFound) return {};
    if (!status) return status;
  }
  return {};
}

Status FlightRun::fly_real_time() {
  clock_.enter();
  const std::int64_t start_ns = clock_.now_ns();
  Status status;
  for (std::int64_t k = 0; k < frames_total_ && status; ++k) {
    if (cancelled()) {
      status = stopped();
      break;
    }
    const std::int64_t t_ns = frame_time_ns(k, scenario_.rate);
    const std::int64_t now_ns = clock_.now_ns() - start_ns;
    if (now_ns >= frame_time_ns(k + 1, scenario_.rate)) {
      // The next frame is due already: drawing this one would only put off that one.
      status = recorder_.add_late_frame(k, t_ns);
      continue;
    }
    if (now_ns < t_ns) clock_.sleep_until_ns(start_ns + t_ns);
    status = fly_frame(k, false);
  }
  clock_.leave();
  if (!status && status.error().code == ErrorCode::kNotFound) return {};
  return status;
}

Status FlightRun::fly_frame(std::int64_t k, bool wait_for_estimators) {
  const std::int64_t t_ns = frame_time_ns(k, scenario_.rate);
  const Result<AircraftState> state =
      stages_.measure("truth", [&] { return truth_->state_at(t_ns); });
  if (!state) return state.error();
  const Pose T_world_camera = state->T_world_body * T_body_camera_;
  Result<renderer::CameraFrame> drawn = stages_.measure("render", [&] {
    return renderer_->render_camera(
        scenario_.camera, T_world_camera, t_ns, renderer::PixelFormat::kGrey8);
  });
  if (!drawn) return drawn.error().in("frame " + std::to_string(k));

  // While this frame was drawn, the estimators worked on the one before.
  if (wait_for_estimators) {
    stages_.measure("wait_for_estimators", [&] {
      for (auto& worker : workers_) worker->wait_until_idle();
      return 0;
    });
  }
  if (Status status = record_events(); !status) return status;

  FrameRecord record;
  record.row.frame = k;
  record.row.t_ns = t_ns;
  record.row.T_world_camera = drawn->T_world_camera;
  record.row.T_world_body = drawn->T_world_camera * T_body_camera_.inverse();
  record.row.texels_per_pixel_median = drawn->texels_per_pixel_median;
  record.row.texels_per_pixel_min = drawn->texels_per_pixel_min;
  record.row.void_fraction = drawn->void_fraction;
  record.axis_depth_m = drawn->axis_depth_m;
  const auto image = std::make_shared<const Image>(std::move(drawn->image));
  for (auto& worker : workers_) {
    VoFrame frame;
    frame.index = k;
    frame.t_ns = t_ns;
    frame.image = image;
    frame.intrinsics = scenario_.camera;
    worker->submit(std::move(frame));
  }
  Status recorded = stages_.measure("record", [&] { return recorder_.add_frame(record, image); });
  if (options_.progress) options_.progress(recorder_.info());
  return recorded;
}

Status FlightRun::record_events() {
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    for (EstimatorEvent& event : workers_[i]->take_events()) {
      if (Status status = recorder_.add_event(i, std::move(event)); !status) return status;
    }
  }
  return {};
}

}  // namespace overfly::engine
