#include "flight/autopilot/mission_preview.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/cancel.hpp"
#include "flight/autopilot/smooth_ground.hpp"
#include "flight/dynamics/trim.hpp"

namespace overfly::autopilot {
namespace {

constexpr int kStepsPerState = 5;
constexpr double kStepS = kPreviewStepS / kStepsPerState;
/// Of the climb behind its demand [s].
constexpr double kClimbLagS = 1.0;
/// Descent and loss of speed in the flare.
constexpr double kFlareSinkMS = 0.8;
constexpr double kFlareSlowingMS2 = 1.0;

/// Moves a value towards a demand with a time constant, at most at a rate.
double followed(double value, double demand, double time_s, double rate_max) {
  return value + kStepS * std::clamp((demand - value) / time_s, -rate_max, rate_max);
}

/// The aircraft as the preview moves it.
class PreviewAircraft {
 public:
  PreviewAircraft(const MissionSetup& setup, const FlightState& start)
      : parameters_(setup.parameters),
        wind_m_s_(setup.wind_world_m_s.head<2>()),
        gravity_m_s2_(setup.environment.gravity_m_s2),
        stall_speed_(setup.airframe, setup.environment),
        position_m_(start.position_world_m),
        yaw_rad_(start.attitude.yaw_rad),
        airspeed_m_s_(start.airspeed_m_s),
        climb_m_s_(start.v_world_m_s.z()) {
    const double up_m = position_m_.z();
    const double cruise = parameters_.airspeed_cruise;
    const auto level =
        dynamics::trim(setup.airframe, setup.environment, {.airspeed_m_s = cruise, .up_m = up_m});
    if (level) alpha_rad_ = level->alpha_rad;
    const auto full = dynamics::trim(
        setup.airframe,
        setup.environment,
        {.airspeed_m_s = cruise, .throttle = 0.01 * parameters_.thr_max, .up_m = up_m});
    take_off_climb_m_s_ =
        full ? std::max(0.5, cruise * std::sin(full->climb_rad)) : parameters_.tecs_clmb_max;
  }

  [[nodiscard]] FlightState state() const {
    FlightState state;
    state.position_world_m = position_m_;
    state.v_world_m_s << velocity_m_s(), climb_m_s_;
    state.attitude = attitude();
    state.airspeed_m_s = airspeed_m_s_;
    state.gravity_m_s2 = gravity_m_s2_;
    return state;
  }

  void step(const FlightDemand& demand, FlightPhase phase) {
    const double stall_m_s = stall_speed_.at_m_s(position_m_.z());
    const double bank_max = bank_limit_rad(stall_m_s, airspeed_m_s_);
    roll_rad_ = followed(roll_rad_,
                         std::clamp(demand.roll_rad, -bank_max, bank_max),
                         parameters_.rll2srv_tconst,
                         rad_from_deg(parameters_.rll2srv_rmax));
    yaw_rad_ = wrap_pi(yaw_rad_ +
                       kStepS * gravity_m_s2_ * std::tan(roll_rad_) / std::max(airspeed_m_s_, 1.0));
    climb_m_s_ = followed(climb_m_s_, climb_demand(demand, phase), kClimbLagS, gravity_m_s2_);
    if (phase == FlightPhase::kFlare) {
      airspeed_m_s_ = std::max(1.1 * stall_m_s, airspeed_m_s_ - kStepS * kFlareSlowingMS2);
    } else {
      airspeed_m_s_ = followed(
          airspeed_m_s_,
          std::clamp(
              demand.energy.airspeed_m_s, parameters_.airspeed_min, parameters_.airspeed_max),
          parameters_.tecs_time_const,
          0.2 * gravity_m_s2_);
    }
    position_m_.head<2>() += kStepS * velocity_m_s();
    position_m_.z() += kStepS * climb_m_s_;
  }

 private:
  [[nodiscard]] RollPitchYaw attitude() const {
    const double path = std::asin(std::clamp(climb_m_s_ / std::max(airspeed_m_s_, 1.0), -1.0, 1.0));
    return {roll_rad_, path + alpha_rad_, yaw_rad_};
  }
  /// Over the ground; the climb takes its part of the airspeed.
  [[nodiscard]] Eigen::Vector2d velocity_m_s() const {
    const double level =
        std::sqrt(std::max(1.0, airspeed_m_s_ * airspeed_m_s_ - climb_m_s_ * climb_m_s_));
    return level * Eigen::Vector2d(std::sin(yaw_rad_), std::cos(yaw_rad_)) + wind_m_s_;
  }
  [[nodiscard]] double climb_demand(const FlightDemand& demand, FlightPhase phase) const {
    if (phase == FlightPhase::kTakeOff) return take_off_climb_m_s_;
    if (phase == FlightPhase::kFlare) return -kFlareSinkMS;
    const double error_m = demand.energy.up_m - position_m_.z();
    return std::clamp(demand.energy.climb_m_s + error_m / parameters_.tecs_time_const,
                      -parameters_.tecs_sink_max,
                      parameters_.tecs_clmb_max);
  }

  Parameters parameters_;
  Eigen::Vector2d wind_m_s_;
  double gravity_m_s2_;
  StallSpeed stall_speed_;
  double alpha_rad_ = 0.0;
  double take_off_climb_m_s_ = 0.0;
  Eigen::Vector3d position_m_;
  double roll_rad_ = 0.0;
  double yaw_rad_;
  double airspeed_m_s_;
  double climb_m_s_;
};

PreviewState preview_state(const FlightState& state,
                           const MissionPilot& pilot,
                           const FlightDemand& demand,
                           double t_s) {
  const bool climbs_out =
      pilot.phase() == FlightPhase::kTakeOff || pilot.phase() == FlightPhase::kFlare;
  return {.t_s = t_s,
          .position_world_m = state.position_world_m,
          .v_world_m_s = state.v_world_m_s,
          .attitude = state.attitude,
          .airspeed_m_s = state.airspeed_m_s,
          .ground_speed_m_s = state.v_world_m_s.head<2>().norm(),
          .height_error_m = climbs_out ? 0.0 : demand.energy.up_m - state.position_world_m.z(),
          .item = pilot.item(),
          .phase = pilot.phase()};
}

}  // namespace

Result<MissionPreview> preview_mission(const MissionSetup& setup,
                                       std::shared_ptr<const HeightQuery> ground,
                                       const std::atomic<bool>* cancel) {
  // Checks everything that the flight itself checks, and gives its first state.
  const Result<MissionFlight> flight = MissionFlight::create(setup, ground);
  if (!flight) return flight.error();
  SmoothGround smooth(ground, ground_smoothing_m(setup.parameters.airspeed_cruise));
  MissionPilot pilot(
      setup.parameters, setup.mission, [&](const Eigen::Vector2d& at) { return smooth.up_m(at); });
  const FlightState start = flight_state(flight->aircraft());
  PreviewAircraft aircraft(setup, start);
  pilot.start(start);
  FlightDemand demand = pilot.update(start, 0.0);
  MissionPreview preview;
  for (int i = 0;; ++i) {
    const FlightState state = aircraft.state();
    preview.states.push_back(preview_state(state, pilot, demand, i * kPreviewStepS));
    if (pilot.phase() == FlightPhase::kDone) break;
    if (state.position_world_m.z() <=
        ground->ground_up_m(state.position_world_m.x(), state.position_world_m.y())) {
      preview.end =
          pilot.phase() == FlightPhase::kFlare ? FlightEnd::kLanded : FlightEnd::kHitGround;
      break;
    }
    if (i * kPreviewStepS >= setup.duration_max_s) {
      preview.end = FlightEnd::kTimeLimit;
      break;
    }
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "the preview was cancelled"};
    for (int part = 0; part < kStepsPerState; ++part) {
      demand = pilot.update(aircraft.state(), kStepS);
      aircraft.step(demand, pilot.phase());
    }
  }
  return preview;
}

}  // namespace overfly::autopilot
