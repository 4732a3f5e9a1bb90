// Features and risk along a flight.
#pragma once

#include <optional>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/predict/drawing_threads.hpp"
#include "server/experiments/predict/prediction.hpp"
#include "server/experiments/predict/walked_flight.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server::predict {

/// A camera of a scenario in flight.
struct FlyingCamera {
  const CameraSpec& spec;
  std::size_t index = 0;  ///< in the scenario
  std::uint64_t seed = 1;
  FrameRate rate;
  std::optional<double> sun_elevation_deg;

  [[nodiscard]] std::int64_t frame_ns() const;
};

/// The instants of a flight with their features and risks.
/// Errors: as PatchCamera and draw_all.
[[nodiscard]] Result<std::vector<PredictedInstant>> flight_risk(const FlyingCamera& camera,
                                                                const WalkedFlight& flight,
                                                                const DrawingThreads& threads);

}  // namespace overfly::server::predict
