#include "server/camera/frame_maker.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include "core/cancel.hpp"
#include "core/sensors/sample_source.hpp"
#include "server/camera/flight_sensors.hpp"
#include "server/camera/truth.hpp"
#include "server/frame_cache/cached_renderer.hpp"
#include "server/frame_cache/frame_key.hpp"
#include "server/worlds/world_cache.hpp"

namespace overfly::server {

FrameMaker::FrameMaker(const Scenario& scenario, const FrameMakerOptions& options)
    : scenario_(scenario),
      options_(options),
      own_stages_(options.stages == nullptr ? std::make_unique<StageTimer>(machine_clock())
                                            : nullptr),
      stages_(options.stages == nullptr ? *own_stages_ : *options.stages),
      faults_(scenario) {}

Result<std::unique_ptr<FrameMaker>> FrameMaker::open(const Scenario& scenario,
                                                     const FrameMakerOptions& options) {
  using Step = Status (FrameMaker::*)();
  std::unique_ptr<FrameMaker> maker(new FrameMaker(scenario, options));
  const std::pair<const char*, Step> steps[] = {{"open_world", &FrameMaker::open_world},
                                                {"plan_flight", &FrameMaker::plan_flight},
                                                {"open_images", &FrameMaker::open_images},
                                                {"open_renderer", &FrameMaker::open_renderer},
                                                {"open_cameras", &FrameMaker::open_cameras}};
  for (const auto& step : steps) {
    if (is_cancelled(options.cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
    Status status = maker->stages_.measure(step.first, [&] { return ((*maker).*step.second)(); });
    if (!status) return status.error();
  }
  return maker;
}

Status FrameMaker::open_world() {
  int last_tenth = 0;
  const auto progress = [&](double share) {
    const int tenth = static_cast<int>(share * 10.0);
    if (tenth > last_tenth && options_.notice) {
      options_.notice("making the built-in world: " + std::to_string(tenth * 10) + " %");
    }
    last_tenth = std::max(last_tenth, tenth);
    return !is_cancelled(options_.cancel);
  };
  WorldCache own;
  WorldCache& worlds = options_.worlds != nullptr ? *options_.worlds : own;
  auto world = worlds.get(scenario_, progress);
  if (!world) return world.error();
  opened_ = *world;
  tiles_ = std::make_shared<const WatchedTiles>(opened_->world.tiles, options_.cancel);
  auto watched = std::make_shared<terrain::World>(opened_->world);
  watched->tiles = tiles_;
  world_ = std::move(watched);
  return {};
}

Status FrameMaker::plan_flight() {
  const auto* live = std::get_if<flight::live::LiveFlight>(&scenario_.flight);
  if (live != nullptr && !options_.open_truth && options_.notice) {
    options_.notice("waiting for the flight of the vehicle on " + live->link.text());
  }
  Result<std::unique_ptr<TruthSource>> truth =
      options_.open_truth ? options_.open_truth(*world_)
                          : create_truth(scenario_, *world_, options_.cancel, options_.vehicle_log);
  if (!truth) return truth.error();
  if (options_.sensing_from_utc_ns) {
    sensors_ = create_sensors(scenario_, *world_, *options_.sensing_from_utc_ns);
    if (sensors_) truth = flight::sensed_while_flown(std::move(*truth), *sensors_);
  }
  if (options_.truth_samples != nullptr) {
    truth = recorded_while_flown(std::move(*truth), *options_.truth_samples);
  }
  if (Status read = check_reading(0); !read) return failed(read.error());
  duration_ns_ = (*truth)->duration_ns();
  truth_ = std::make_unique<TruthWindow>(std::move(*truth));
  if (scenario_.duration_s) {
    const std::int64_t wanted_ns = ns_from_s(*scenario_.duration_s);
    duration_ns_ = duration_ns_ ? std::min(*duration_ns_, wanted_ns) : wanted_ns;
  }
  constexpr std::int64_t kDayNs = 86400 * kNsPerS;
  frames_total_ = frame_count(duration_ns_.value_or(kDayNs), scenario_.rate);
  return {};
}

Status FrameMaker::open_images() {
  const CameraSpec* const camera = scenario_.recorded_camera();
  if (camera == nullptr) return {};
  if (!duration_ns_) {
    return Error{ErrorCode::kInvalidArgument,
                 "camera \"" + camera->name + "\": images: the length of the flight is not known"};
  }
  const FlightStart start{scenario_.epoch_utc_ns, log_start_ns(), *duration_ns_};
  auto images = FlightImages::open(*camera, start, scenario_.sources, options_.cancel);
  if (!images) return images.error();
  images_ = std::move(*images);
  frames_total_ = images_->count();
  return {};
}

std::int64_t FrameMaker::frame_ns(std::int64_t k) const {
  if (!images_) return frame_time_ns(k, scenario_.rate);
  if (k < frames_total_) return images_->t_ns(k);
  return images_->t_ns(frames_total_ - 1) + frame_time_ns(k + 1 - frames_total_, scenario_.rate);
}

std::vector<std::string> FrameMaker::image_warnings() const {
  return images_ ? images_->warnings() : std::vector<std::string>();
}

Status FrameMaker::open_renderer() {
  Result<std::unique_ptr<renderer::Renderer>> made =
      make_renderer(scenario_, tiles_, options_.renderer_factory);
  if (!made) return made.error();
  renderer_ = std::move(*made);
  const renderer::RendererInfo info = renderer_->info();
  if (options_.frame_cache != nullptr && CachedRenderer::pays_for(info)) {
    renderer_ = std::make_unique<CachedRenderer>(
        std::move(renderer_), picture_context(scenario_, *opened_, info), *options_.frame_cache);
  }
  return {};
}

Status FrameMaker::open_cameras() {
  for (std::size_t i = 0; i < scenario_.cameras.size(); ++i) {
    auto unit = CameraUnit::create(scenario_.cameras[i], i, scenario_.seed);
    if (!unit) return unit.error();
    if (faults_.may_freeze(i)) (*unit)->keep_last_image();
    cameras_.push_back(std::move(*unit));
  }
  window_ = ShutterWindow::of(cameras_);
  return {};
}

SensorSamples FrameMaker::take_samples(std::int64_t t_ns) {
  SensorSamples samples;
  if (SampleSource* const own = truth_->source().sample_source(); own != nullptr) {
    samples = own->take_samples(t_ns);
    const flight::SensorModels& simulated = scenario_.sensors;
    if (simulated.imu) samples.imu.clear();
    if (simulated.barometer) samples.barometer.clear();
    if (simulated.gps) samples.gps.clear();
    if (simulated.airspeed) samples.airspeed.clear();
    if (simulated.magnetometer) samples.magnetometer.clear();
    if (simulated.range) samples.range.clear();
  }
  if (sensors_) append(samples, sensors_->take_until(t_ns));
  return samples;
}

std::string FrameMaker::sensor_report() const {
  const SampleSource* const own = truth_->source().sample_source();
  return own != nullptr ? own->sensor_report() : std::string();
}

Status FrameMaker::check_reading(int late_tiles) const {
  if (Status heights = tiles_->status(); !heights) return heights;
  return late_tiles > 0 ? tiles_->unread() : Status();
}

Error FrameMaker::failed(const Error& error) {
  if (options_.worlds != nullptr) options_.worlds->drop(opened_);
  return error;
}

Result<std::optional<MadeFrame>> FrameMaker::make(std::int64_t k) {
  MadeFrame made;
  made.frame = k;
  made.t_ns = frame_ns(k);
  const auto around =
      stages_.measure("truth", [&]() -> Result<std::optional<std::vector<AircraftState>>> {
        auto states = truth_->around(
            made.t_ns, window_.half_ns, window_.raster_ns, frame_ns(k + 1), options_.cancel);
        if (options_.truth_samples == nullptr || !states) return states;
        if (Status written = options_.truth_samples->flush(); !written) return written.error();
        return states;
      });
  if (!around) return failed(around.error());
  if (!*around) return std::optional<MadeFrame>();
  const std::vector<AircraftState>& states = **around;
  made.state = states[states.size() / 2];
  made.sensors = take_samples(made.t_ns);
  next_frame_ = k + 1;
  made.shots.resize(cameras_.size());
  // A recorded camera takes what is known of its view from the camera that it is compared with.
  for (const bool recorded : {false, true}) {
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      if (scenario_.cameras[i].images.has_value() != recorded) continue;
      Result<CameraShot> shot = recorded ? fetch(i, k, states, made.shots) : take(i, k, states);
      if (!shot) return failed(shot.error().in("frame " + std::to_string(k)));
      made.shots[i] = std::move(*shot);
    }
  }
  return std::optional(std::move(made));
}

Result<CameraShot> FrameMaker::take(std::size_t camera,
                                    std::int64_t k,
                                    const std::vector<AircraftState>& states) {
  const std::int64_t t_ns = states[states.size() / 2].t_ns;
  CameraShot shot;
  shot.camera = camera;
  shot.name = scenario_.cameras[camera].name;
  const FrameFaults faults = faults_.at(camera, k, t_ns);
  shot.stamp_ns = faults.stamp_ns;
  shot.faults = faults.names;
  shot.delivered = !faults.dropped;
  CameraUnit& unit = *cameras_[camera];
  Result<renderer::CameraRequest> request = unit.request(states, t_ns);
  if (!request) return request.error();
  request->tile_wait_ns = options_.wait_for_tiles ? renderer::kForAllTiles : 0;
  shot.request = std::move(*request);
  Result<renderer::CameraFrame> drawn =
      stages_.measure("render", [&] { return renderer_->render_camera(shot.request); });
  if (!drawn) return drawn.error();
  if (Status read = check_reading(drawn->late_tiles); !read) return read.error();
  const Status developed =
      stages_.measure("sensor", [&] { return unit.develop(std::move(*drawn), faults, k, shot); });
  if (!developed) return developed.error();
  return shot;
}

Result<CameraShot> FrameMaker::fetch(std::size_t camera,
                                     std::int64_t k,
                                     const std::vector<AircraftState>& states,
                                     const std::vector<CameraShot>& rendered) {
  const std::int64_t t_ns = states[states.size() / 2].t_ns;
  const std::optional<std::size_t> other = scenario_.cameras[camera].images->compare_with;
  CameraShot shot;
  if (other) {
    shot.drawn.texels_per_pixel_min = rendered[*other].drawn.texels_per_pixel_min;
    shot.drawn.texels_per_pixel_median = rendered[*other].drawn.texels_per_pixel_median;
    shot.drawn.void_fraction = rendered[*other].drawn.void_fraction;
    shot.drawn.axis_depth_m = rendered[*other].drawn.axis_depth_m;
    shot.drawn.camera = scenario_.cameras[camera].model;
    shot.drawn.t_ns = t_ns;
    Result<renderer::CameraRequest> request = cameras_[camera]->request(states, t_ns);
    if (!request) return request.error();
    shot.request = std::move(*request);
    shot.drawn.T_world_camera = shot.request.T_world_camera.at(t_ns);
  } else {
    Result<CameraShot> taken = take(camera, k, states);
    if (!taken) return taken;
    shot = std::move(*taken);
  }
  shot.camera = camera;
  shot.name = scenario_.cameras[camera].name;
  shot.stamp_ns = t_ns;
  shot.source_image = images_->source_index(k);
  Result<Image> image = stages_.measure("read_image", [&] { return images_->read(k); });
  shot.delivered = image.ok();
  shot.image = image ? std::move(*image) : Image();
  if (!image) {
    shot.problem = image.error().message;
    shot.faults.emplace_back(kUnreadableImage);
  }
  return shot;
}

Result<SensorSamples> FrameMaker::record_last_period() {
  if (options_.truth_samples == nullptr) return SensorSamples();
  const std::int64_t end_ns = frame_ns(next_frame_);
  const auto last = truth_->at(end_ns, options_.cancel);
  if (!last) return failed(last.error());
  if (Status written = options_.truth_samples->flush(); !written) return written.error();
  return take_samples(end_ns);
}

Status FrameMaker::fetch_first_view() {
  // A live flight is not asked before it begins, also if the scenario limits its duration.
  if (!truth_->source().duration_ns()) return {};
  const auto first = truth_->at(0, options_.cancel);
  if (!first) return failed(first.error());
  if (!*first) return Error{ErrorCode::kInvalidArgument, "flight: ends before its first frame"};
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    const auto frame =
        renderer_->render_camera(scenario_.cameras[camera].model,
                                 cameras_[camera]->T_world_camera((*first)->T_world_body, 0),
                                 0,
                                 renderer::PixelFormat::kGrey8);
    if (!frame) return failed(frame.error().in("camera " + scenario_.cameras[camera].name));
  }
  return {};
}

}  // namespace overfly::server
