#include "flight/live/live_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/time.hpp"
#include "flight/dynamics/environment.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight::live {
namespace {

/// Of samples around a time: the first one not before it. @pre there is one, and it is not the
/// first of all unless its time is t_ns
template <typename Sample>
typename std::deque<Sample>::const_iterator not_before(const std::deque<Sample>& samples,
                                                       std::int64_t t_ns) {
  return std::lower_bound(
      samples.begin(), samples.end(), t_ns, [](const Sample& sample, std::int64_t t) {
        return sample.t_ns < t;
      });
}

/// The constant rate, about the body's axes, that turns one attitude into the other.
Eigen::Vector3d mean_rate(const LiveAttitude& from, const LiveAttitude& to) {
  Eigen::Quaterniond step = from.R_ned_body.conjugate() * to.R_ned_body;
  if (step.w() < 0.0) step.coeffs() = -step.coeffs();
  const Eigen::AngleAxisd turn(step);
  return turn.axis() * (turn.angle() / s_from_ns(to.t_ns - from.t_ns));
}

constexpr double kSeaLevelDensityKgM3 = 1.225;

}  // namespace

std::string seconds_shown(std::int64_t t_ns) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f s", s_from_ns(t_ns));
  return text;
}

Geodetic LiveMotion::point_of(const Eigen::Vector3d& geodetic) const {
  return geodetic_from_deg(geodetic.x(), geodetic.y(), geodetic.z() + geoid_separation_m_);
}

/// Position and velocity of a sample in the world frame.
AircraftState LiveMotion::state_of(const LivePosition& position) const {
  const Geodetic point = point_of(position.geodetic);
  AircraftState state;
  state.t_ns = position.t_ns;
  state.T_world_body.translation = frame_.world_from_geodetic(point);
  state.v_body_world_m_s = frame_.R_world_enu_at(point) * (logs::R_enu_ned() * position.v_ned_m_s);
  if (position.indicated_airspeed_m_s >= 0.0) {
    // MAVLink has the indicated airspeed; the state has the true one.
    const double density = dynamics::standard_density_kg_m3(point.alt_ellipsoid_m);
    state.airspeed_m_s =
        position.indicated_airspeed_m_s * std::sqrt(kSeaLevelDensityKgM3 / density);
  }
  return state;
}

/// Without an airspeed the ground speed takes its place.
void LiveMotion::complete_airspeed(const LivePosition& position, AircraftState& state) {
  if (position.indicated_airspeed_m_s < 0.0) state.airspeed_m_s = state.v_body_world_m_s.norm();
}

void LiveMotion::note_gap(std::int64_t begin_ns, std::int64_t end_ns) {
  const std::int64_t gap_ns = end_ns - begin_ns;
  if (gap_ns <= gap_limit_ns_ || begin_ns <= last_gap_begin_ns_) return;
  last_gap_begin_ns_ = begin_ns;
  ++gaps_;
  if (gap_ns <= longest_gap_ns_) return;
  longest_gap_ns_ = gap_ns;
  longest_gap_at_ns_ = begin_ns;
}

void LiveMotion::set_attitude(const std::deque<LiveAttitude>& attitudes,
                              bool joint,
                              std::int64_t t_ns,
                              AircraftState& state) {
  const auto after = not_before(attitudes, t_ns);
  const LiveAttitude& b = *after;
  const LiveAttitude& a = b.t_ns == t_ns ? b : *std::prev(after);
  Eigen::Quaterniond R_ned_body = b.R_ned_body;
  Eigen::Vector3d rate_rad_s = b.rate_rad_s;
  if (a.t_ns != b.t_ns) {
    // Of one stream the gap of the positions is the same.
    if (!joint) note_gap(a.t_ns, b.t_ns);
    const double part = s_from_ns(t_ns - a.t_ns) / s_from_ns(b.t_ns - a.t_ns);
    R_ned_body = a.R_ned_body.slerp(part, b.R_ned_body);
    if (a.has_rate && b.has_rate) {
      rate_rad_s = (1.0 - part) * a.rate_rad_s + part * b.rate_rad_s;
    } else {
      rate_rad_s = mean_rate(a, b);
    }
  } else if (!b.has_rate && attitudes.size() > 1) {
    const bool is_first = after == attitudes.begin();
    rate_rad_s = is_first ? mean_rate(b, *std::next(after)) : mean_rate(*std::prev(after), b);
  }
  const Geodetic point = frame_.geodetic_from_world(state.T_world_body.translation);
  state.T_world_body.rotation =
      (frame_.R_world_enu_at(point) * logs::R_enu_ned() * R_ned_body).normalized();
  state.omega_body_rad_s = rate_rad_s;
}

AircraftState LiveMotion::at(const std::deque<LivePosition>& positions,
                             const std::deque<LiveAttitude>& attitudes,
                             bool joint,
                             std::int64_t t_ns) {
  const auto after = not_before(positions, t_ns);
  AircraftState state;
  if (after->t_ns == t_ns) {
    state = state_of(*after);
    if (!after->has_velocity && positions.size() > 1) {
      const auto other = after != positions.begin() ? std::prev(after) : std::next(after);
      state.v_body_world_m_s =
          (state_of(*other).T_world_body.translation - state.T_world_body.translation) /
          s_from_ns(other->t_ns - t_ns);
    }
    complete_airspeed(*after, state);
  } else {
    const auto before = std::prev(after);
    note_gap(before->t_ns, after->t_ns);
    AircraftState a = state_of(*before);
    AircraftState b = state_of(*after);
    if (!before->has_velocity || !after->has_velocity) {
      a.v_body_world_m_s = b.v_body_world_m_s =
          (b.T_world_body.translation - a.T_world_body.translation) / s_from_ns(b.t_ns - a.t_ns);
    }
    complete_airspeed(*before, a);
    complete_airspeed(*after, b);
    state = interpolate(a, b, t_ns);
  }
  set_attitude(attitudes, joint, t_ns, state);
  state.t_ns = t_ns;
  return state;
}

std::optional<std::string> LiveMotion::gaps_text(std::int64_t start_ns) const {
  if (gaps_ == 0) return std::nullopt;
  return std::to_string(gaps_) + " gaps between samples are longer than " +
         seconds_shown(gap_limit_ns_) + " and were interpolated; the longest one, at " +
         seconds_shown(longest_gap_at_ns_ - start_ns) + ", is " + seconds_shown(longest_gap_ns_) +
         " long";
}

}  // namespace overfly::flight::live
