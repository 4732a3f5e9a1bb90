// The course of flight.hpp flown by an airframe with its autopilot instead of coordinated turns.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "flight/autopilot/mission_flight.hpp"
#include "flight/flight.hpp"

namespace overfly::autopilot {

struct CourseAircraft {
  dynamics::Airframe airframe;
  /// Velocity of the air relative to world, expressed in world [m/s].
  Eigen::Vector3d wind_world_m_s = Eigen::Vector3d::Zero();
  std::optional<dynamics::TurbulenceLevel> turbulence = {};
  /// Heights follow the smoothed ground; else the height above the ground at the start is kept.
  bool follow_ground = true;
  std::map<std::string, double> parameters = {};  ///< ArduPlane's names; over `tuned_for`
};

/// The course as a mission: waypoints at the end of the first leg, half-way through the turn, at
/// every extreme of the oscillating return, and at the end.
/// @param track_ground_up_m  height of flat ground, for heights that do not follow it
[[nodiscard]] Mission course_mission(const flight::CourseParameters& course,
                                     const CourseAircraft& aircraft,
                                     double track_ground_up_m);

/// Parameters for the course: `tuned_for` its airspeed, its roll rate and bank limits, and those
/// given. Waypoints are turned at with the bank limit.
/// Errors: as tuned_for and set_parameter.
[[nodiscard]] Result<Parameters> course_autopilot(const flight::CourseParameters& course,
                                                  const CourseAircraft& aircraft,
                                                  const dynamics::Environment& environment,
                                                  double up_m);

/// Errors: as fly_course for the parameters, course_autopilot and fly_mission.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_course(
    const flight::CourseParameters& course,
    const CourseAircraft& aircraft,
    const dynamics::Environment& environment,
    std::shared_ptr<const HeightQuery> ground,
    std::uint64_t seed,
    const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::autopilot
