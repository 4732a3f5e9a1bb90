#include "flight/autopilot/mission_pilot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace overfly::autopilot {
namespace {

/// A circle counts as reached within this share of its radius.
constexpr double kCaptureShare = 0.15;
/// A circle's height counts as reached within this distance.
constexpr double kHeightReachedM = 3.0;
/// A circle is left for the next item within this angle of the course to it, at the latest after
/// another turn: nothing points to an item inside the circle.
constexpr double kExitAngleDeg = 10.0;

}  // namespace

const char* name_of(FlightPhase phase) {
  switch (phase) {
    case FlightPhase::kTakeOff:
      return "take-off";
    case FlightPhase::kEnRoute:
      return "en route";
    case FlightPhase::kLoiter:
      return "loiter";
    case FlightPhase::kReturn:
      return "return";
    case FlightPhase::kLanding:
      return "landing";
    case FlightPhase::kFlare:
      return "flare";
    case FlightPhase::kDone:
      return "done";
  }
  return "";
}

MissionPilot::MissionPilot(const Parameters& parameters, Mission mission, GroundHeight ground)
    : parameters_(parameters),
      mission_(std::move(mission)),
      ground_(std::move(ground)),
      guidance_(parameters) {}

double MissionPilot::up_of(const MissionItem& item, const Eigen::Vector2d& at_m) const {
  return item.above_ground ? ground_(at_m) + item.height_m : item.height_m;
}

void MissionPilot::start(const FlightState& state, std::size_t item) {
  index_ = item;
  heading_rad_ = state.attitude.yaw_rad;
  for (std::size_t i = 0; i < std::min(item, mission_.items.size()); ++i) take_speed(i);
  begin_item(state);
  from_m_ = state.position_world_m.head<2>();
}

void MissionPilot::set_parameters(const Parameters& parameters) {
  // On the way to another circle no turns count.
  const bool other_circle = parameters.wp_loiter_rad != parameters_.wp_loiter_rad;
  const bool has_item = index_ < mission_.items.size();
  if (other_circle && has_item && mission_.items[index_].radius_m == 0.0) captured_ = false;
  parameters_ = parameters;
  guidance_.set_parameters(parameters);
  if (phase_ == FlightPhase::kReturn) place_return();
}

bool MissionPilot::take_speed(std::size_t item) {
  if (mission_.items[item].command != MissionCommand::kSetSpeed) return false;
  set_airspeed_m_s_ = mission_.items[item].airspeed_m_s;
  return true;
}

void MissionPilot::place_return() {
  MissionItem& item = mission_.items[index_];
  item.position_m = mission_.home_world_m.head<2>();
  item.height_m = mission_.home_world_m.z() + parameters_.rtl_altitude;
  item.above_ground = false;
}

/// The line to an item starts at the position of the item before it, the first one's where the
/// aircraft is; so do heights.
void MissionPilot::begin_item(const FlightState& state) {
  while (index_ < mission_.items.size() && take_speed(index_)) ++index_;
  circled_rad_ = circling_s_ = 0.0;
  captured_ = false;
  circled_at_height_rad_.reset();
  cross_track_m_ = 0.0;
  if (index_ >= mission_.items.size()) {
    phase_ = FlightPhase::kDone;
    return;
  }
  const MissionItem& item = mission_.items[index_];
  const Eigen::Vector2d here = state.position_world_m.head<2>();
  from_m_ = here;
  for (std::size_t before = index_; before > 0; --before) {
    const MissionItem& last = mission_.items[before - 1];
    if (last.command == MissionCommand::kSetSpeed) continue;
    if (last.command == MissionCommand::kWaypoint) from_m_ = last.position_m;
    break;
  }
  switch (item.command) {
    case MissionCommand::kTakeOff:
      phase_ = FlightPhase::kTakeOff;
      break;
    case MissionCommand::kLoiter:
      phase_ = FlightPhase::kLoiter;
      break;
    case MissionCommand::kLand:
      phase_ = FlightPhase::kLanding;
      break;
    case MissionCommand::kReturn:
      phase_ = FlightPhase::kReturn;
      place_return();
      break;
    default:
      phase_ = FlightPhase::kEnRoute;
      break;
  }
  from_height_m_ = state.position_world_m.z() - (item.above_ground ? ground_(here) : 0.0);
}

double MissionPilot::roll_for(double acceleration_m_s2, const FlightState& state) const {
  const double limit = rad_from_deg(parameters_.roll_limit_deg);
  return std::clamp(std::atan(acceleration_m_s2 / state.gravity_m_s2), -limit, limit);
}

/// How far before a waypoint the turn to the next line begins: the turn's radius times the tangent
/// of half the change of direction, at 60 deg at most.
double MissionPilot::turn_lead_m(const FlightState& state) const {
  const MissionItem& item = mission_.items[index_];
  for (std::size_t next = index_ + 1; next < mission_.items.size(); ++next) {
    const MissionItem& after = mission_.items[next];
    if (after.command == MissionCommand::kSetSpeed) continue;
    const Eigen::Vector2d in = item.position_m - from_m_;
    const Eigen::Vector2d out =
        (after.command == MissionCommand::kReturn ? Eigen::Vector2d(mission_.home_world_m.head<2>())
                                                  : after.position_m) -
        item.position_m;
    if (in.norm() < 1.0 || out.norm() < 1.0) return 0.0;
    const double change = std::acos(std::clamp(in.normalized().dot(out.normalized()), -1.0, 1.0));
    const double speed = state.v_world_m_s.head<2>().norm();
    const double radius =
        speed * speed / (state.gravity_m_s2 * std::tan(rad_from_deg(parameters_.roll_limit_deg)));
    const double lead = radius * std::tan(0.5 * std::min(change, rad_from_deg(120.0)));
    return std::min(lead, 0.5 * std::min(in.norm(), out.norm()));
  }
  return 0.0;
}

bool MissionPilot::reached(const FlightState& state) const {
  const MissionItem& item = mission_.items[index_];
  const Eigen::Vector2d here = state.position_world_m.head<2>();
  switch (item.command) {
    case MissionCommand::kTakeOff:
      return state.position_world_m.z() >= up_of(item, here) - 1.0;
    case MissionCommand::kWaypoint: {
      const double radius = item.accept_radius_m > 0.0
                                ? item.accept_radius_m
                                : std::max(turn_lead_m(state), 0.2 * parameters_.wp_radius);
      const Eigen::Vector2d line = item.position_m - from_m_;
      const Eigen::Vector2d left = item.position_m - here;
      if (left.norm() <= radius) return true;
      // Past the waypoint counts too: a missed one is not chased.
      return line.norm() >= 1.0 ? left.dot(line.normalized()) <= std::min(radius, 1.0)
                                : left.norm() <= parameters_.wp_radius;
    }
    case MissionCommand::kLoiter:
    case MissionCommand::kReturn:
      if (item.until_height) {
        return circled_at_height_rad_ &&
               (heads_for_next(state) || circled_rad_ >= *circled_at_height_rad_ + 2.0 * kPi);
      }
      if (item.turns) return circled_rad_ >= *item.turns * 2.0 * kPi;
      return item.time_s && captured_ && circling_s_ >= *item.time_s;
    default:
      return false;
  }
}

bool MissionPilot::heads_for_next(const FlightState& state) const {
  for (std::size_t next = index_ + 1; next < mission_.items.size(); ++next) {
    const MissionItem& item = mission_.items[next];
    if (item.command == MissionCommand::kSetSpeed) continue;
    const Eigen::Vector2d way =
        (item.command == MissionCommand::kReturn ? Eigen::Vector2d(mission_.home_world_m.head<2>())
                                                 : item.position_m) -
        state.position_world_m.head<2>();
    const Eigen::Vector2d velocity = state.v_world_m_s.head<2>();
    const double off = std::atan2(way.x(), way.y()) - std::atan2(velocity.x(), velocity.y());
    return std::abs(wrap_pi(off)) < rad_from_deg(kExitAngleDeg);
  }
  return true;
}

FlightDemand MissionPilot::fly_line(const FlightState& state) {
  const MissionItem& item = mission_.items[index_];
  const Eigen::Vector2d here = state.position_world_m.head<2>();
  const Eigen::Vector2d velocity = state.v_world_m_s.head<2>();
  FlightDemand demand;
  demand.roll_rad = roll_for(guidance_.along_line(from_m_, item.position_m, here, velocity), state);
  demand.energy.airspeed_m_s = airspeed_m_s();
  const Eigen::Vector2d line = item.position_m - from_m_;
  const double length = line.norm();
  double share = 1.0;
  if (length >= 1.0) {
    const Eigen::Vector2d along = line / length;
    share = std::clamp((here - from_m_).dot(along) / length, 0.0, 1.0);
    const Eigen::Vector2d off = here - from_m_;
    cross_track_m_ = along.y() * off.x() - along.x() * off.y();
  }
  // Heights change in proportion to the way along the line. Over ground, the demand's rate follows
  // from the ground ahead.
  constexpr double kAheadS = 1.0;
  const auto up_at = [&](double at, const Eigen::Vector2d& position) {
    const double height = from_height_m_ + (item.height_m - from_height_m_) * at;
    return item.above_ground ? ground_(position) + height : height;
  };
  demand.energy.up_m = up_at(share, here);
  const double progress =
      length >= 1.0 ? std::max(0.0, velocity.dot(line) / (length * length)) * kAheadS : 0.0;
  const double ahead = up_at(std::min(1.0, share + progress), here + kAheadS * velocity);
  demand.energy.climb_m_s = (ahead - demand.energy.up_m) / kAheadS;
  return demand;
}

FlightDemand MissionPilot::fly_circle(const FlightState& state, double dt_s) {
  const MissionItem& item = mission_.items[index_];
  const double radius = item.radius_m != 0.0 ? item.radius_m : parameters_.wp_loiter_rad;
  const Eigen::Vector2d here = state.position_world_m.head<2>();
  const Eigen::Vector2d out = here - item.position_m;
  const double bearing = std::atan2(out.x(), out.y());
  cross_track_m_ = out.norm() - std::abs(radius);
  if (captured_) {
    circled_rad_ +=
        std::max(0.0, std::copysign(1.0, radius) * wrap_pi(bearing - last_bearing_rad_));
    circling_s_ += dt_s;
  } else {
    captured_ = std::abs(cross_track_m_) < kCaptureShare * std::abs(radius);
  }
  last_bearing_rad_ = bearing;
  const double off_m = up_of(item, here) - state.position_world_m.z();
  if (captured_ && !circled_at_height_rad_ && std::abs(off_m) < kHeightReachedM) {
    circled_at_height_rad_ = circled_rad_;
  }
  FlightDemand demand;
  demand.roll_rad = roll_for(
      guidance_.around_circle(item.position_m, radius, here, state.v_world_m_s.head<2>()), state);
  demand.energy = {.up_m = up_of(item, here), .climb_m_s = 0.0, .airspeed_m_s = airspeed_m_s()};
  return demand;
}

FlightDemand MissionPilot::climb_out(const FlightState& state) const {
  FlightDemand demand;
  const Eigen::Vector2d velocity = state.v_world_m_s.head<2>();
  const double drift = wrap_pi(heading_rad_ - std::atan2(velocity.x(), velocity.y()));
  const double limit = rad_from_deg(15.0);  // near the ground the wings stay almost level
  demand.roll_rad = std::clamp(drift, -limit, limit);
  demand.energy = {.up_m = up_of(mission_.items[index_], state.position_world_m.head<2>()),
                   .climb_m_s = 0.0,
                   .airspeed_m_s = airspeed_m_s()};
  // Less pitch while the launch leaves the aircraft slow.
  const double slow =
      std::clamp(state.airspeed_m_s / parameters_.airspeed_min - 0.6, 0.0, 0.6) / 0.6;
  demand.pitch_rad = rad_from_deg(parameters_.tkoff_lvl_pitch) * slow;
  demand.throttle = 0.01 * parameters_.thr_max;
  return demand;
}

FlightDemand MissionPilot::flare(const FlightState& state) const {
  FlightDemand demand;
  demand.roll_rad = 0.0;
  demand.energy.up_m = state.position_world_m.z();
  demand.energy.airspeed_m_s = parameters_.airspeed_min;
  demand.pitch_rad = rad_from_deg(parameters_.land_pitch_deg);
  demand.throttle = 0.0;
  return demand;
}

FlightDemand MissionPilot::update(const FlightState& state, double dt_s) {
  while (phase_ != FlightPhase::kDone && reached(state)) {
    ++index_;
    begin_item(state);
  }
  switch (phase_) {
    case FlightPhase::kTakeOff:
      return climb_out(state);
    case FlightPhase::kLoiter:
    case FlightPhase::kReturn:
      return fly_circle(state, dt_s);
    case FlightPhase::kLanding: {
      const Eigen::Vector2d here = state.position_world_m.head<2>();
      if (state.position_world_m.z() - ground_(here) > parameters_.land_flare_alt) {
        FlightDemand demand = fly_line(state);
        demand.energy.airspeed_m_s = std::max(parameters_.airspeed_min, 0.9 * airspeed_m_s());
        return demand;
      }
      phase_ = FlightPhase::kFlare;
      return flare(state);
    }
    case FlightPhase::kFlare:
      return flare(state);
    case FlightPhase::kEnRoute:
      return fly_line(state);
    case FlightPhase::kDone:
      break;
  }
  // After the last item the wings are level and the height is held.
  FlightDemand demand;
  demand.energy = {
      .up_m = state.position_world_m.z(), .climb_m_s = 0.0, .airspeed_m_s = airspeed_m_s()};
  return demand;
}

}  // namespace overfly::autopilot
