#include "core/motion/truth_source.hpp"

#include "core/time.hpp"

namespace overfly {

AircraftState interpolate(const AircraftState& a, const AircraftState& b, std::int64_t t_ns) {
  const double dt_s = s_from_ns(b.t_ns - a.t_ns);
  const double u = s_from_ns(t_ns - a.t_ns) / dt_s;
  const double u2 = u * u;
  const double u3 = u2 * u;
  const Eigen::Vector3d& p0 = a.T_world_body.translation;
  const Eigen::Vector3d& p1 = b.T_world_body.translation;
  const Eigen::Vector3d m0 = a.v_body_world_m_s * dt_s;
  const Eigen::Vector3d m1 = b.v_body_world_m_s * dt_s;

  AircraftState state;
  state.t_ns = t_ns;
  state.T_world_body = interpolate(a.T_world_body, b.T_world_body, u);
  state.T_world_body.translation =
      (2 * u3 - 3 * u2 + 1) * p0 + (u3 - 2 * u2 + u) * m0 + (3 * u2 - 2 * u3) * p1 + (u3 - u2) * m1;
  state.v_body_world_m_s =
      ((6 * u2 - 6 * u) * (p0 - p1) + (3 * u2 - 4 * u + 1) * m0 + (3 * u2 - 2 * u) * m1) / dt_s;
  state.omega_body_rad_s = (1.0 - u) * a.omega_body_rad_s + u * b.omega_body_rad_s;
  state.airspeed_m_s = (1.0 - u) * a.airspeed_m_s + u * b.airspeed_m_s;
  return state;
}

}  // namespace overfly
