// What a mission is expected to be like: its path over the ground, its turns, and what a camera of
// the aircraft sees, compared with limits.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/result.hpp"
#include "flight/autopilot/mission_preview.hpp"
#include "server/scenario/scenario.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

inline constexpr std::size_t kMinMissionSamples = 20;
inline constexpr std::size_t kMaxMissionSamples = 600;
inline constexpr std::size_t kMaxFootprints = 60;

/// Values beyond these are warnings.
struct MissionLimits {
  double min_clearance_m = 50.0;  ///< above the ground, except in take-off and landing
  double max_bank_deg = 45.0;
  double min_overlap = 0.6;     ///< of images `overlap_interval_s` apart
  double min_texels_px = 0.5;   ///< below, the imagery limits the result, not the camera
  double max_motion_px = 60.0;  ///< between frames, rotation and translation together
  double min_imagery = 0.95;    ///< share of the image over imagery
  /// The straight and level beginning that an estimator initialises in: its duration, and its
  /// length over the height above the ground.
  double min_start_s = 10.0;
  double min_start_baseline = 0.5;
};

struct MissionRequest {
  MissionLimits limits;
  std::string camera;  ///< by name; empty = the first
  double overlap_interval_s = 1.0;
  std::size_t samples = 300;
};

/// The mission at an instant. What the camera sees is empty where it does not see the ground; the
/// overlap also at the end.
struct MissionSample {
  autopilot::PreviewState state;
  std::optional<std::uint16_t> item;  ///< its number in the mission's file
  double distance_m = 0.0;            ///< over ground, from the start
  Geodetic place;
  double ground_up_m = 0.0;  ///< below it, world frame
  double clearance_m = 0.0;
  double imagery = 0.0;
  std::optional<double> overlap;
  std::optional<double> texels_px;
  double rotation_px = 0.0;
  double translation_px = 0.0;
};

/// A position of the mission as it is flown.
struct MissionPlace {
  std::uint16_t number = 0;  ///< in the mission's file
  Geodetic place;
  double ground_ellipsoid_m = 0.0;
  double height_agl_m = 0.0;
  double height_above_home_m = 0.0;  ///< as heights above home are flown: in the world frame
  std::optional<double> reached_s;
  /// Of the turn at a waypoint or in a circle, by the formula of coordinated turns at the airspeed
  /// (and, in wind, the ground speed's largest value) and the turn's radius.
  std::optional<double> turn_radius_m;
  std::optional<double> turn_bank_deg;
};

/// A straight and level part of the flight.
struct StartLeg {
  double from_s = 0.0;
  double to_s = 0.0;
  double length_m = 0.0;
  double height_agl_m = 0.0;
  bool enough = false;  ///< meets the limits
  [[nodiscard]] double baseline() const {
    return height_agl_m > 0.0 ? length_m / height_agl_m : 0.0;
  }
};

struct Footprint {
  double t_s = 0.0;
  std::array<Geodetic, 4> corners;
};

struct MissionWarning {
  std::string kind;  ///< "clearance", "bank", "overlap", "texture", "motion", "imagery", "start",
                     ///< "climb", "flight", "plan"
  std::string text;
  std::optional<double> from_s = {};
  std::optional<double> to_s = {};
  std::optional<std::uint16_t> item = {};  ///< its number in the mission's file
  std::optional<double> value = {};        ///< the worst one, in the unit of `limit`
  std::optional<double> limit = {};
};

struct MissionReport {
  std::vector<MissionSample> samples;  ///< equal times apart, and the one of the least clearance
  std::vector<MissionPlace> places;
  std::vector<Footprint> footprints;
  std::optional<StartLeg> start;  ///< the first that is enough, else the longest
  std::vector<MissionWarning> warnings;
  autopilot::FlightEnd end = autopilot::FlightEnd::kMissionDone;
  double duration_s = 0.0;
  double distance_m = 0.0;
  double roll_limit_deg = 0.0;  ///< of the autopilot
  std::string camera;
};

/// @param scenario  flies a mission
/// Errors: kInvalidArgument for another flight, and for a camera that the scenario does not have;
/// as mission_setup and autopilot::preview_mission.
[[nodiscard]] Result<MissionReport> report_mission(const Scenario& scenario,
                                                   const terrain::World& world,
                                                   const MissionRequest& request,
                                                   const std::atomic<bool>* cancel = nullptr);

/// Compares a report with limits; adds nothing else than `warnings`.
void add_warnings(const MissionRequest& request,
                  const autopilot::MissionSetup& setup,
                  MissionReport& report);

}  // namespace overfly::server
