#include "server/experiments/predict/flight_risk.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/time.hpp"
#include "server/experiments/predict/features/instant_features.hpp"
#include "server/experiments/predict/features/patch_camera.hpp"
#include "server/experiments/predict/risk_model.hpp"

namespace overfly::server::predict {
namespace {

/// Consecutive instants of one call: auto-exposure settles once in them.
constexpr std::size_t kBlock = 24;

Result<Features> features_at(const FlyingCamera& camera,
                             const WalkedFlight& flight,
                             std::size_t index,
                             const terrain::TileSource& tiles,
                             PatchCamera& patches,
                             renderer::Renderer& renderer) {
  const std::int64_t t_ns = flight.instant_ns(index);
  const auto states = flight.states_around(t_ns, patches.half_window_ns(), patches.raster_ns());
  const Result<PatchShot> shot =
      patches.expose(states, t_ns, static_cast<std::int64_t>(index), renderer);
  if (!shot) return shot.error();
  const auto pose_after = [&](std::int64_t dt_ns) {
    return patches.T_world_camera(flight.T_world_body_at(t_ns + dt_ns), t_ns + dt_ns);
  };
  const ViewPoses poses{
      pose_after(0), pose_after(camera.frame_ns()), pose_after(ns_from_s(kOverlapS))};
  return features_of(camera.spec.model, *shot, t_ns, poses, tiles, camera.sun_elevation_deg);
}

Status measure_block(const FlyingCamera& camera,
                     const WalkedFlight& flight,
                     std::size_t first,
                     const terrain::TileSource& tiles,
                     renderer::Renderer& renderer,
                     std::vector<PredictedInstant>& instants) {
  auto patches = PatchCamera::create(camera.spec, camera.index, camera.seed, kFlightPatches);
  if (!patches) return patches.error();
  const std::size_t end = std::min(first + kBlock, instants.size());
  for (int i = 1; i < (*patches)->settling_shots(); ++i) {
    const auto settled = features_at(camera, flight, first, tiles, **patches, renderer);
    if (!settled) return settled.error();
  }
  for (std::size_t k = first; k < end; ++k) {
    const auto features = features_at(camera, flight, k, tiles, **patches, renderer);
    if (!features) return features.error();
    PredictedInstant& instant = instants[k];
    const std::int64_t t_ns = flight.instant_ns(k);
    const Eigen::Vector3d at = flight.T_world_body_at(t_ns).translation;
    instant.t_s = s_from_ns(t_ns);
    instant.east_m = at.x();
    instant.north_m = at.y();
    instant.height_agl_m = at.z() - tiles.ground_up_m(at.x(), at.y());
    instant.features = *features;
  }
  return {};
}

void add_risks(double step_s, std::vector<PredictedInstant>& instants) {
  const RiskModel& model = fitted_model();
  std::vector<Inputs> inputs;
  inputs.reserve(instants.size());
  for (const PredictedInstant& instant : instants) inputs.push_back(inputs_of(instant.features));
  std::vector<double> hazards;
  for (std::size_t k = 0; k < instants.size(); ++k) {
    PredictedInstant& instant = instants[k];
    instant.window = window_inputs(inputs, k, step_s);
    instant.contributions = contributions_of(model, instant.window);
    hazards.push_back(hazard_of(model, instant.window));
    instant.risk = risk_within(hazards.back(), kRiskSpanS);
  }
  const std::vector<double> so_far = risk_so_far(hazards, step_s);
  for (std::size_t k = 0; k < instants.size(); ++k) instants[k].risk_so_far = so_far[k];
}

}  // namespace

std::int64_t FlyingCamera::frame_ns() const { return frame_time_ns(1, rate); }

Result<std::vector<PredictedInstant>> flight_risk(const FlyingCamera& camera,
                                                  const WalkedFlight& flight,
                                                  const DrawingThreads& threads) {
  std::vector<PredictedInstant> instants(flight.instants());
  const std::size_t blocks = (instants.size() + kBlock - 1) / kBlock;
  const Status drawn =
      draw_all(threads, blocks, [&](std::size_t block, renderer::Renderer& renderer) {
        return measure_block(camera, flight, block * kBlock, *threads.tiles, renderer, instants);
      });
  if (!drawn) return drawn.error();
  add_risks(flight.step_s(), instants);
  return instants;
}

}  // namespace overfly::server::predict
