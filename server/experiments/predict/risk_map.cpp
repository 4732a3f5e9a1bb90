#include "server/experiments/predict/risk_map.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/measure/quantile.hpp"
#include "core/time.hpp"
#include "server/camera/truth_window.hpp"
#include "server/experiments/predict/features/instant_features.hpp"
#include "server/experiments/predict/features/patch_camera.hpp"
#include "server/experiments/predict/risk_model.hpp"

namespace overfly::server::predict {
namespace {

/// The imagery's rectangle in the world frame, by points along its sides.
Eigen::AlignedBox2d imagery_box(const terrain::TileSource& tiles) {
  const terrain::TileGrid& grid = tiles.grid();
  Eigen::AlignedBox2d box;
  constexpr int kPoints = 8;
  for (int i = 0; i <= kPoints; ++i) {
    const double x = grid.left_x_m + grid.width_m * i / kPoints;
    const double y = grid.top_y_m - grid.height_m * i / kPoints;
    for (const Eigen::Vector3d& at : {tiles.world_from_map(x, grid.top_y_m),
                                      tiles.world_from_map(x, grid.top_y_m - grid.height_m),
                                      tiles.world_from_map(grid.left_x_m, y),
                                      tiles.world_from_map(grid.left_x_m + grid.width_m, y)}) {
      box.extend(at.head<2>().eval());
    }
  }
  return box;
}

/// The middle of the fullest sector of 10 deg, clockwise from north [rad].
double main_heading_rad(const std::vector<Pose>& path) {
  constexpr int kSectors = 36;
  std::array<int, kSectors> counts{};
  for (const Pose& T_world_body : path) {
    const double yaw_deg = deg_from_rad(attitude_from(T_world_body.rotation).yaw_rad) + 360.0;
    ++counts[static_cast<std::size_t>(std::lround(yaw_deg / 10.0)) % kSectors];
  }
  const auto fullest = std::max_element(counts.begin(), counts.end());
  return rad_from_deg(10.0 * static_cast<double>(fullest - counts.begin()));
}

/// Level flight over a place.
AircraftState level_state(const MapPlan& plan, const Eigen::Vector3d& p_world, std::int64_t t_ns) {
  AircraftState state;
  state.t_ns = t_ns;
  state.T_world_body = {R_world_body_from({0.0, 0.0, plan.heading_rad}), p_world};
  state.v_body_world_m_s =
      plan.speed_m_s * Eigen::Vector3d(std::sin(plan.heading_rad), std::cos(plan.heading_rad), 0.0);
  state.airspeed_m_s = plan.speed_m_s;
  return state;
}

class Mapper {
 public:
  Mapper(const FlyingCamera& camera,
         const MapPlan& plan,
         const terrain::TileSource& tiles,
         RiskMap& map)
      : camera_(camera), plan_(plan), tiles_(tiles), map_(map) {}

  Status draw_row(std::size_t row, renderer::Renderer& renderer) const {
    auto patches = PatchCamera::create(camera_.spec, camera_.index, camera_.seed, kMapPatches);
    if (!patches) return patches.error();
    bool settled = false;
    for (std::size_t column = 0; column < map_.columns; ++column) {
      const double east = map_.west_m + (static_cast<double>(column) + 0.5) * map_.cell_m;
      const double north = map_.south_m + (static_cast<double>(row) + 0.5) * map_.cell_m;
      const Eigen::Vector2d at = tiles_.map_from_world(east, north);
      if (!tiles_.has_imagery(at.x(), at.y())) continue;
      const std::size_t cell = map_.index(column, row);
      const int shots = settled ? 1 : (*patches)->settling_shots();
      for (int i = 0; i < shots; ++i) {
        const auto features = features_over({east, north}, cell, **patches, renderer);
        if (!features) return features.error();
        map_.features[cell] = *features;
      }
      settled = true;
      map_.risk[cell] =
          risk_within(hazard_of(fitted_model(), inputs_of(map_.features[cell])), kRiskSpanS);
    }
    return {};
  }

 private:
  [[nodiscard]] Result<Features> features_over(const Eigen::Vector2d& place,
                                               std::size_t cell,
                                               PatchCamera& patches,
                                               renderer::Renderer& renderer) const {
    // Within the motion of a mount that vibrates.
    constexpr std::int64_t kAtNs = 10 * kNsPerS;
    const double up = tiles_.ground_up_m(place.x(), place.y()) + plan_.height_agl_m;
    const AircraftState middle = level_state(plan_, {place.x(), place.y(), up}, kAtNs);
    const std::int64_t raster_ns = patches.raster_ns();
    const std::int64_t n = (patches.half_window_ns() + raster_ns - 1) / raster_ns;
    std::vector<AircraftState> states;
    for (std::int64_t j = -n; j <= n; ++j) states.push_back(extrapolated(middle, j * raster_ns));
    const Result<PatchShot> shot =
        patches.expose(states, kAtNs, static_cast<std::int64_t>(cell), renderer);
    if (!shot) return shot.error();
    const auto pose_after = [&](std::int64_t dt_ns) {
      return patches.T_world_camera(extrapolated(middle, dt_ns).T_world_body, kAtNs + dt_ns);
    };
    const ViewPoses poses{
        pose_after(0), pose_after(camera_.frame_ns()), pose_after(ns_from_s(kOverlapS))};
    return features_of(camera_.spec.model, *shot, kAtNs, poses, tiles_, camera_.sun_elevation_deg);
  }

  const FlyingCamera& camera_;
  const MapPlan& plan_;
  const terrain::TileSource& tiles_;
  RiskMap& map_;
};

}  // namespace

std::optional<MapPlan> plan_map(const WalkedFlight& flight,
                                const terrain::TileSource& tiles,
                                double side_m,
                                double cell_m) {
  Eigen::AlignedBox2d track;
  std::vector<double> heights_m;
  for (std::size_t i = 0; i < flight.instants(); ++i) {
    const Eigen::Vector3d at = flight.T_world_body_at(flight.instant_ns(i)).translation;
    track.extend(at.head<2>().eval());
    heights_m.push_back(at.z() - tiles.ground_up_m(at.x(), at.y()));
  }
  const Eigen::Vector2d half(0.5 * side_m, 0.5 * side_m);
  const Eigen::Vector2d centre = track.center();
  const Eigen::AlignedBox2d box =
      imagery_box(tiles).intersection(Eigen::AlignedBox2d(centre - half, centre + half));
  if (box.isEmpty() || box.sizes().minCoeff() <= 0.0) return std::nullopt;
  MapPlan plan;
  plan.west_m = box.min().x();
  plan.south_m = box.min().y();
  plan.east_m = box.max().x();
  plan.north_m = box.max().y();
  plan.cell_m = cell_m;
  plan.height_agl_m = std::max(1.0, quantile(std::move(heights_m), 0.5));
  plan.speed_m_s = flight.length_m() / flight.duration_s();
  plan.heading_rad = main_heading_rad(flight.path());
  return plan;
}

Result<RiskMap> risk_map(const FlyingCamera& camera,
                         const MapPlan& plan,
                         const DrawingThreads& threads) {
  RiskMap map;
  map.west_m = plan.west_m;
  map.south_m = plan.south_m;
  map.cell_m = plan.cell_m;
  const auto cells = [&](double length_m) {
    return static_cast<std::size_t>(std::ceil(length_m / plan.cell_m - 1e-6));
  };
  map.columns = std::max<std::size_t>(1, cells(plan.east_m - plan.west_m));
  map.rows = std::max<std::size_t>(1, cells(plan.north_m - plan.south_m));
  if (map.columns > kMostCells || map.rows > kMostCells) {
    return Error{ErrorCode::kInvalidArgument,
                 "map = " + std::to_string(map.columns) + " x " + std::to_string(map.rows) +
                     " cells: must be at most " + std::to_string(kMostCells) +
                     " along a side; take larger cells or a smaller map"};
  }
  map.height_agl_m = plan.height_agl_m;
  map.speed_m_s = plan.speed_m_s;
  map.heading_deg = deg_from_rad(plan.heading_rad);
  map.risk.resize(map.columns * map.rows);
  map.features.resize(map.columns * map.rows);
  const Mapper mapper(camera, plan, *threads.tiles, map);
  const Status drawn =
      draw_all(threads, map.rows, [&](std::size_t row, renderer::Renderer& renderer) {
        return mapper.draw_row(row, renderer);
      });
  if (!drawn) return drawn.error();
  return map;
}

}  // namespace overfly::server::predict
