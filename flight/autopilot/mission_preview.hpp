// The predicted flight of a mission, a hundred times faster than its simulation.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/earth/height_query.hpp"
#include "core/motion/pose.hpp"
#include "flight/autopilot/mission_flight.hpp"

namespace overfly::autopilot {

/// Time between the states of a preview [s].
inline constexpr double kPreviewStepS = 0.1;

struct PreviewState {
  double t_s = 0.0;
  Eigen::Vector3d position_world_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_world_m_s = Eigen::Vector3d::Zero();
  RollPitchYaw attitude;
  double airspeed_m_s = 0.0;
  double ground_speed_m_s = 0.0;
  double height_error_m = 0.0;  ///< of the aircraft below the demand
  std::size_t item = 0;         ///< of the mission; their number when it is done
  FlightPhase phase = FlightPhase::kEnRoute;
};

struct MissionPreview {
  std::vector<PreviewState> states;  ///< kPreviewStepS apart, at least one
  FlightEnd end = FlightEnd::kMissionDone;
};

/// The mission's pilot with an aircraft that turns without sideslip (turn rate g tan(bank) / V),
/// and whose bank, airspeed and climb follow the demands with the autopilot's time constants and
/// limits. Turbulence and the aircraft's oscillations are left out; the pitch is the angle of the
/// path plus the level flight's angle of attack.
/// @param cancel  may be null
/// Errors: as MissionFlight::create; kCancelled.
[[nodiscard]] Result<MissionPreview> preview_mission(const MissionSetup& setup,
                                                     std::shared_ptr<const HeightQuery> ground,
                                                     const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::autopilot
