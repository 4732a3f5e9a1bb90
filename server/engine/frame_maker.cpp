#include "server/engine/frame_maker.hpp"

#include <algorithm>
#include <utility>

#include "server/engine/truth.hpp"
#include "server/engine/world_cache.hpp"

namespace overfly::engine {
namespace {

bool is_set(const std::atomic<bool>* flag) { return flag != nullptr && flag->load(); }

renderer::CameraRequest request_for(const CameraSpec& camera,
                                    std::int64_t t_ns,
                                    const AircraftState& state,
                                    bool wait_for_tiles) {
  renderer::CameraRequest request;
  request.camera = camera.model;
  request.T_world_camera = state.T_world_body * camera.T_body_camera;
  request.t_ns = t_ns;
  request.format = camera.rgb ? renderer::PixelFormat::kRgb8 : renderer::PixelFormat::kGrey8;
  request.quality = camera.quality;
  request.atmosphere = camera.atmosphere;
  request.velocity_world_m_s = state.v_body_world_m_s;
  request.wait_for_tiles = wait_for_tiles;
  return request;
}

}  // namespace

FrameMaker::FrameMaker(const Scenario& scenario, const FrameMakerOptions& options)
    : scenario_(scenario),
      options_(options),
      own_stages_(options.stages == nullptr ? std::make_unique<StageTimer>(machine_clock())
                                            : nullptr),
      stages_(options.stages == nullptr ? *own_stages_ : *options.stages) {}

Result<std::unique_ptr<FrameMaker>> FrameMaker::open(const Scenario& scenario,
                                                     const FrameMakerOptions& options) {
  using Step = Status (FrameMaker::*)();
  std::unique_ptr<FrameMaker> maker(new FrameMaker(scenario, options));
  const std::pair<const char*, Step> steps[] = {{"open_world", &FrameMaker::open_world},
                                                {"plan_flight", &FrameMaker::plan_flight},
                                                {"open_renderer", &FrameMaker::open_renderer}};
  for (const auto& step : steps) {
    if (is_set(options.cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
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
    return !is_set(options_.cancel);
  };
  WorldCache own;
  WorldCache& worlds = options_.worlds != nullptr ? *options_.worlds : own;
  auto world = worlds.get(scenario_, progress);
  if (!world) return world.error();
  world_ = *world;
  return {};
}

Status FrameMaker::plan_flight() {
  Result<std::unique_ptr<TruthSource>> truth = create_truth(scenario_, *world_);
  if (!truth) return truth.error();
  truth_ = std::move(*truth);
  duration_ns_ = truth_->duration_ns();
  if (scenario_.duration_s) {
    const std::int64_t wanted_ns = ns_from_s(*scenario_.duration_s);
    duration_ns_ = duration_ns_ ? std::min(*duration_ns_, wanted_ns) : wanted_ns;
  }
  constexpr std::int64_t kDayNs = 86400 * kNsPerS;
  frames_total_ = frame_count(duration_ns_.value_or(kDayNs), scenario_.rate);
  return {};
}

Status FrameMaker::open_renderer() {
  Result<std::unique_ptr<renderer::Renderer>> made =
      options_.renderer_factory ? options_.renderer_factory(world_->tiles)
                                : renderer::create_egl_renderer(world_->tiles);
  if (!made) return made.error();
  renderer_ = std::move(*made);
  return {};
}

Result<MadeFrame> FrameMaker::make(std::int64_t k) {
  MadeFrame made;
  made.frame = k;
  made.t_ns = frame_time_ns(k, scenario_.rate);
  const Result<AircraftState> state =
      stages_.measure("truth", [&] { return truth_->state_at(made.t_ns); });
  if (!state) return state.error();
  made.state = *state;
  for (std::size_t i = 0; i < scenario_.cameras.size(); ++i) {
    Result<CameraShot> shot = take(i, made.t_ns, *state);
    if (!shot) return shot.error().in("frame " + std::to_string(k));
    made.shots.push_back(std::move(*shot));
  }
  return made;
}

Result<CameraShot> FrameMaker::take(std::size_t camera,
                                    std::int64_t t_ns,
                                    const AircraftState& state) {
  const CameraSpec& spec = scenario_.cameras[camera];
  CameraShot shot;
  shot.camera = camera;
  shot.name = spec.name;
  shot.stamp_ns = t_ns;
  shot.request = request_for(spec, t_ns, state, options_.wait_for_tiles);
  Result<renderer::CameraFrame> drawn =
      stages_.measure("render", [&] { return renderer_->render_camera(shot.request); });
  if (!drawn) return drawn.error();
  shot.drawn = std::move(*drawn);
  shot.image = std::move(shot.drawn.image);
  return shot;
}

Result<Trajectory> FrameMaker::rehearse(std::size_t camera) const {
  // A flight of its own: a truth source never goes back in time.
  const Result<std::unique_ptr<TruthSource>> truth = create_truth(scenario_, *world_);
  if (!truth) return truth.error();
  const Pose& T_body_camera = scenario_.cameras[camera].T_body_camera;
  std::vector<StampedPose> poses;
  for (std::int64_t k = 0; k < frames_total_; ++k) {
    const std::int64_t t_ns = frame_time_ns(k, scenario_.rate);
    const Result<AircraftState> state = (*truth)->state_at(t_ns);
    if (!state && state.error().code == ErrorCode::kNotFound) break;
    if (!state) return state.error();
    poses.push_back({t_ns, state->T_world_body * T_body_camera});
  }
  return Trajectory::from_poses(poses);
}

Result<std::optional<double>> FrameMaker::depth_at_start(std::size_t camera) {
  const Result<std::unique_ptr<TruthSource>> truth = create_truth(scenario_, *world_);
  if (!truth) return truth.error();
  const Result<AircraftState> first = (*truth)->state_at(0);
  if (!first) return first.error();
  const CameraSpec& spec = scenario_.cameras[camera];
  const Result<renderer::CameraFrame> frame = renderer_->render_camera(
      spec.model, first->T_world_body * spec.T_body_camera, 0, renderer::PixelFormat::kGrey8);
  if (!frame) return frame.error();
  return frame->axis_depth_m;
}

}  // namespace overfly::engine
