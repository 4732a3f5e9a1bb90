#include "flight/playback/topics/flight_moments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/text/number_text.hpp"
#include "core/time.hpp"
#include "flight/gravity.hpp"

namespace overfly::flight::playback {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// To 1e-9 deg and 1 mm, so that a line of text states it exactly.
Geodetic rounded_place(const Geodetic& place) {
  const auto rounded = [](double value, double steps) { return std::round(value * steps) / steps; };
  return geodetic_from_deg(rounded(deg_from_rad(place.lat_rad), 1e9),
                           rounded(deg_from_rad(place.lon_rad), 1e9),
                           rounded(place.alt_ellipsoid_m, 1e3));
}

}  // namespace

Result<FlightMoments> FlightMoments::create(PlayedFlight played) {
  if (Status status = check_message_rate(played.rate_hz); !status) return status.error();
  const std::optional<std::int64_t> length_ns = played.flight->duration_ns();
  if (!length_ns) {
    return Error{ErrorCode::kUnsupported,
                 played.flight->description() + ": the length of the flight is not known"};
  }
  FlightMoments moments(std::move(played));
  const PlayedFlight& flight = moments.played_;
  moments.length_ns_ = *length_ns;
  moments.period_ns_ = std::llround(1e9 / flight.rate_hz);
  moments.count_ = *length_ns / moments.period_ns_ + 1;
  moments.epoch_ns_ = flight.unix_at_start_ns.value_or(
      std::max(flight.flight->log_start_ns().value_or(0), kNsPerS));
  const auto first = flight.flight->state_at(0);
  if (!first) return first.error();
  if (!*first) {
    return Error{ErrorCode::kNotFound, flight.flight->description() + ": the flight has no state"};
  }
  moments.map_ = flight.is_placed ? flight.frame
                                  : LocalFrame(rounded_place(flight.frame.geodetic_from_world(
                                        (*first)->T_world_body.translation)));
  return moments;
}

Result<std::optional<FlightMoment>> FlightMoments::at(std::int64_t number) {
  if (number < 0 || number >= count_) return std::optional<FlightMoment>();
  FlightMoment moment;
  moment.number = number;
  moment.t_ns = number * period_ns_;
  const std::int64_t from_ns = std::max<std::int64_t>(0, moment.t_ns - period_ns_ / 2);
  const std::int64_t to_ns = std::min(length_ns_, moment.t_ns + period_ns_ / 2);
  const auto before = played_.flight->state_at(from_ns);
  if (!before) return before.error();
  const auto found = played_.flight->state_at(moment.t_ns);
  if (!found) return found.error();
  const auto after = played_.flight->state_at(to_ns);
  if (!after) return after.error();
  if (!*found) return std::optional<FlightMoment>();
  const AircraftState& state = **found;
  const LocalFrame& frame = played_.frame;
  const Geodetic place = frame.geodetic_from_world(state.T_world_body.translation);
  const Eigen::Quaterniond R_world_enu = frame.R_world_enu_at(place);
  moment.R_enu_body = R_world_enu.conjugate() * state.T_world_body.rotation;
  moment.T_map_body = state.T_world_body;
  if (!played_.is_placed) {
    moment.T_map_body.translation = map_.world_from_geodetic(place);
    moment.T_map_body.rotation = map_.R_world_enu_at(place) * moment.R_enu_body;
  }
  const Eigen::Vector3d v_enu = R_world_enu.conjugate() * state.v_body_world_m_s;
  moment.gps = {moment.t_ns,
                moment.t_ns,
                GpsFixType::k3d,
                place,
                {v_enu.y(), v_enu.x(), -v_enu.z()},
                kNotKnown,
                kNotKnown,
                kNotKnown};
  moment.imu.t_ns = moment.t_ns;
  moment.imu.angular_rate_rad_s = state.omega_body_rad_s;
  moment.imu.acceleration_m_s2.setConstant(kNotKnown);
  if (*before && *after && to_ns > from_ns) {
    const Eigen::Vector3d acceleration_world =
        ((*after)->v_body_world_m_s - (*before)->v_body_world_m_s) / s_from_ns(to_ns - from_ns);
    const Eigen::Vector3d up_world = R_world_enu * Eigen::Vector3d::UnitZ();
    moment.imu.acceleration_m_s2 = state.T_world_body.rotation.conjugate() *
                                   (acceleration_world + normal_gravity_m_s2(place) * up_world);
  }
  return std::optional(moment);
}

}  // namespace overfly::flight::playback
