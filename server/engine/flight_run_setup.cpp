// FlightRun: everything before the first frame.
#include <cmath>
#include <utility>

#include "server/engine/flight_run.hpp"
#include "server/engine/truth.hpp"
#include "server/engine/world_cache.hpp"

namespace overfly::engine {
namespace {

using Json = nlohmann::json;

/// t = 0 of lockstep runs, so that equal runs have equal manifests: 2026-01-01T00:00:00Z.
constexpr std::int64_t kLockstepEpochUtcNs = 1'767'225'600 * kNsPerS;

}  // namespace

Status FlightRun::open_world() {
  int last_tenth = 0;
  const auto progress = [&](double share) {
    const int tenth = static_cast<int>(share * 10.0);
    if (tenth > last_tenth && options_.notice) {
      options_.notice("making the built-in world: " + std::to_string(tenth * 10) + " %");
    }
    last_tenth = std::max(last_tenth, tenth);
    return !cancelled();
  };
  WorldCache own;
  WorldCache& worlds = options_.worlds != nullptr ? *options_.worlds : own;
  auto world = worlds.get(scenario_, progress);
  if (!world) return world.error();
  world_ = *world;
  recorder_.set_attribution(world_->tiles->attribution());
  Json hashes = Json::array();
  for (const auto& [file, digest] : world_->data_hashes) {
    hashes.push_back({{"file", file}, {"digest", digest}});
  }
  const Geodetic& origin = world_->tiles->frame().origin();
  recorder_.manifest()["world"] = {{"name", world_->spec.name},
                                   {"attribution", world_->tiles->attribution()},
                                   {"warnings", world_->warnings},
                                   {"data_hashes", std::move(hashes)},
                                   {"origin",
                                    {{"lat_deg", deg_from_rad(origin.lat_rad)},
                                     {"lon_deg", deg_from_rad(origin.lon_rad)},
                                     {"alt_ellipsoid_m", origin.alt_ellipsoid_m}}}};
  for (const std::string& warning : world_->warnings) {
    if (Status status = recorder_.log(0, "warning", warning); !status) return status;
  }
  return {};
}

Status FlightRun::plan_flight() {
  Result<std::unique_ptr<TruthSource>> truth = create_truth(scenario_, *world_);
  if (!truth) return truth.error();
  truth_ = std::move(*truth);
  std::optional<std::int64_t> duration_ns = truth_->duration_ns();
  if (scenario_.duration_s) {
    const std::int64_t wanted_ns = ns_from_s(*scenario_.duration_s);
    duration_ns = duration_ns ? std::min(*duration_ns, wanted_ns) : wanted_ns;
  }
  constexpr std::int64_t kDayNs = 86400 * kNsPerS;
  frames_total_ = frame_count(duration_ns.value_or(kDayNs), scenario_.rate);
  recorder_.set_length(duration_ns.value_or(0), duration_ns ? frames_total_ : 0);
  recorder_.set_mount(T_body_camera_);
  recorder_.manifest()["flight"] = {{"description", truth_->description()}};
  return {};
}

Status FlightRun::open_renderer() {
  Result<std::unique_ptr<renderer::Renderer>> made =
      options_.renderer_factory ? options_.renderer_factory(world_->tiles)
                                : renderer::create_egl_renderer(world_->tiles);
  if (!made) return made.error();
  renderer_ = std::move(*made);
  const renderer::RendererInfo info = renderer_->info();
  recorder_.manifest()["renderer"] = {{"backend", info.backend},
                                      {"device", info.device},
                                      {"gl_version", info.gl_version},
                                      {"software", info.software}};
  return recorder_.log(0, "info", "drawn by " + info.backend + ": " + info.device);
}

Result<ToyTruth> FlightRun::toy_truth(double scene_depth_m) const {
  // A flight of its own: a truth source never goes back in time.
  const Result<std::unique_ptr<TruthSource>> rehearsal = create_truth(scenario_, *world_);
  if (!rehearsal) return rehearsal.error();
  std::vector<StampedPose> poses;
  for (std::int64_t k = 0; k < frames_total_; ++k) {
    const std::int64_t t_ns = frame_time_ns(k, scenario_.rate);
    const Result<AircraftState> state = (*rehearsal)->state_at(t_ns);
    if (!state && state.error().code == ErrorCode::kNotFound) break;
    if (!state) return state.error();
    poses.push_back({t_ns, state->T_world_body * T_body_camera_});
  }
  Result<Trajectory> trajectory = Trajectory::from_poses(poses);
  if (!trajectory) return trajectory.error();
  return ToyTruth{std::move(*trajectory), scene_depth_m};
}

Status FlightRun::open_estimators() {
  const auto truth = [&]() -> Result<ToyTruth> {
    const Result<std::unique_ptr<TruthSource>> rehearsal = create_truth(scenario_, *world_);
    if (!rehearsal) return rehearsal.error();
    const Result<AircraftState> first = (*rehearsal)->state_at(0);
    if (!first) return first.error();
    const Result<renderer::CameraFrame> frame = renderer_->render_camera(
        scenario_.camera, first->T_world_body * T_body_camera_, 0, renderer::PixelFormat::kGrey8);
    if (!frame) return frame.error();
    return toy_truth(frame->axis_depth_m.value_or(0.0));
  };
  for (std::size_t i = 0; i < scenario_.estimators.size(); ++i) {
    const EstimatorSpec& spec = scenario_.estimators[i];
    Result<std::unique_ptr<VoPort>> port = options_.estimator_factory
                                               ? options_.estimator_factory(spec)
                                               : create_estimator(spec, scenario_.seed, truth);
    if (!port) return port.error();
    recorder_.manifest()["estimators"][i]["parameters"] = (*port)->effective_parameters();
    workers_.push_back(
        std::make_unique<EstimatorWorker>(std::move(*port), scenario_.record_debug_hz, clock_));
  }
  return {};
}

Status FlightRun::describe() {
  const bool wall = scenario_.pacing == Pacing::kRealTime;
  recorder_.manifest()["epoch_utc_ns"] =
      scenario_.epoch_utc_ns.value_or(wall ? utc_now_ns() : kLockstepEpochUtcNs);
  return recorder_.write_manifest();
}

}  // namespace overfly::engine
