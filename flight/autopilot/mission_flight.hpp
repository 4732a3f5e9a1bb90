// A flight of an airframe by the autopilot, as a source of truth.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/earth/height_query.hpp"
#include "core/motion/truth_source.hpp"
#include "core/result.hpp"
#include "flight/autopilot/autopilot.hpp"
#include "flight/autopilot/smooth_ground.hpp"

namespace overfly::autopilot {

/// Rate of the equations of motion [Hz]; a multiple of kControlRateHz.
inline constexpr double kMotionRateHz = 400.0;
/// Longest flight of a mission [s].
inline constexpr double kFlightMaxS = 6.0 * 3600.0;
/// Airspeed of a launch over the stall speed.
inline constexpr double kLaunchOverStall = 1.15;

struct MissionSetup {
  dynamics::Airframe airframe;
  dynamics::Environment environment;
  Parameters parameters;
  Mission mission;
  /// Velocity of the air relative to world, expressed in world [m/s].
  Eigen::Vector3d wind_world_m_s = Eigen::Vector3d::Zero();
  std::optional<dynamics::TurbulenceLevel> turbulence;
  std::uint64_t seed = 0;  ///< of the turbulence
  /// Start in steady flight at this position; else a launch from home, 1.5 m above the ground.
  std::optional<Eigen::Vector3d> start_world_m;
  double heading_rad = 0.0;  ///< of the start, clockwise from north
  /// Ends the flight early [s], in (0, kFlightMaxS].
  double duration_max_s = kFlightMaxS;
  std::string title = "mission";      ///< first words of the description
  std::vector<std::string> warnings;  ///< of what was left out of the mission, for the run
  bool report_items = true;           ///< phases and items are events of the flight
};

enum class FlightEnd {
  kMissionDone,
  kLanded,     ///< touched the ground in the flare
  kHitGround,  ///< touched it in any other phase
  kTimeLimit,
};

/// Spacing of the SmoothGround that an aircraft of this cruise speed follows [m]: terrain is
/// followed without bumps below this length.
[[nodiscard]] double ground_smoothing_m(double airspeed_m_s);

/// An aircraft at the moment of its launch: 1.5 m above a place on the ground, level, at
/// kLaunchOverStall times its stall speed, or at AIRSPEED_CRUISE if that is less.
/// Errors: as dynamics::trim and Aircraft::create.
[[nodiscard]] Result<dynamics::Aircraft> launch(const dynamics::AircraftSetup& aircraft,
                                                const Parameters& parameters,
                                                const Eigen::Vector3d& place_world_m,
                                                double heading_rad);

/// The simulation: aircraft and autopilot step by step. Equal setups give equal flights.
class MissionFlight {
 public:
  /// Errors: kInvalidArgument naming field, value and limit; as trim for an airspeed that the
  /// airframe cannot fly, check(Mission) and check(Parameters); ground without a height.
  [[nodiscard]] static Result<MissionFlight> create(const MissionSetup& setup,
                                                    std::shared_ptr<const HeightQuery> ground);

  /// One period of control, 1 / kControlRateHz. No effect after the end.
  /// Errors: kInvalidArgument where the ground has no height.
  [[nodiscard]] Status step();

  [[nodiscard]] const std::optional<FlightEnd>& end() const { return end_; }
  [[nodiscard]] std::int64_t t_ns() const;
  [[nodiscard]] const dynamics::Aircraft& aircraft() const { return aircraft_; }
  [[nodiscard]] const Autopilot& autopilot() const { return autopilot_; }
  [[nodiscard]] const MissionSetup& setup() const { return *setup_; }
  /// The state at a time within the latest step, interpolated between steps of the motion.
  [[nodiscard]] AircraftState state_at(std::int64_t t_ns) const;

 private:
  MissionFlight(std::shared_ptr<const MissionSetup> setup,
                std::shared_ptr<const HeightQuery> ground,
                std::shared_ptr<SmoothGround> smooth,
                dynamics::Aircraft aircraft);
  [[nodiscard]] Status check_ground();

  static constexpr int kParts = static_cast<int>(kMotionRateHz / kControlRateHz);

  std::shared_ptr<const MissionSetup> setup_;
  std::shared_ptr<const HeightQuery> ground_;
  std::shared_ptr<SmoothGround> smooth_;
  dynamics::Aircraft aircraft_;
  Autopilot autopilot_;
  std::int64_t steps_ = 0;
  std::array<AircraftState, kParts + 1> states_;  // of the latest step
  std::optional<FlightEnd> end_;
};

/// Flies the mission once to its end, to learn its duration and what happens, and gives it as a
/// source of truth that flies it again. Contact with the ground ends the flight; its `warnings` say
/// so unless it is a landing.
/// @param cancel  ends the first flight; may be null
/// Errors: as MissionFlight::create and step; kCancelled.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_mission(
    const MissionSetup& setup,
    std::shared_ptr<const HeightQuery> ground,
    const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::autopilot
