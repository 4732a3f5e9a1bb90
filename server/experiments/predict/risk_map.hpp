// Risk of straight and level flight over the area around a mission.
#pragma once

#include <cstddef>

#include "core/result.hpp"
#include "server/experiments/predict/drawing_threads.hpp"
#include "server/experiments/predict/flight_risk.hpp"
#include "server/experiments/predict/prediction.hpp"

namespace overfly::server::predict {

/// The most cells along a side.
inline constexpr std::size_t kMostCells = 250;

/// Where the map lies and what is flown over it.
struct MapPlan {
  double west_m = 0.0;  ///< world frame
  double south_m = 0.0;
  double east_m = 0.0;
  double north_m = 0.0;
  double cell_m = 100.0;
  double height_agl_m = 0.0;
  double speed_m_s = 0.0;
  double heading_rad = 0.0;
};

/// A square of `side_m` around the middle of the flight, as far as there is imagery; empty if there
/// is none. Height and speed are the medians of the flight, the heading that of its longest time
/// (in sectors of 10 deg).
[[nodiscard]] std::optional<MapPlan> plan_map(const WalkedFlight& flight,
                                              const terrain::TileSource& tiles,
                                              double side_m,
                                              double cell_m);

/// Errors: kInvalidArgument for more than kMostCells; as PatchCamera and draw_all.
[[nodiscard]] Result<RiskMap> risk_map(const FlyingCamera& camera,
                                       const MapPlan& plan,
                                       const DrawingThreads& threads);

}  // namespace overfly::server::predict
