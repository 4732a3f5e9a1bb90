#include "server/camera/truth_window.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "core/time.hpp"

namespace overfly::server {
namespace {

AircraftState between(const AircraftState& a, const AircraftState& b, std::int64_t t_ns) {
  const double alpha = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
  AircraftState state;
  state.t_ns = t_ns;
  state.T_world_body = interpolate(a.T_world_body, b.T_world_body, alpha);
  const auto mixed = [alpha](const auto& x, const auto& y) {
    return (1.0 - alpha) * x + alpha * y;
  };
  state.v_body_world_m_s = mixed(a.v_body_world_m_s, b.v_body_world_m_s);
  state.omega_body_rad_s = mixed(a.omega_body_rad_s, b.omega_body_rad_s);
  state.airspeed_m_s = mixed(a.airspeed_m_s, b.airspeed_m_s);
  return state;
}

}  // namespace

AircraftState extrapolated(const AircraftState& state, std::int64_t dt_ns) {
  const double dt_s = s_from_ns(dt_ns);
  AircraftState moved = state;
  moved.t_ns = state.t_ns + dt_ns;
  moved.T_world_body.translation += dt_s * state.v_body_world_m_s;
  const Eigen::Vector3d turn = dt_s * state.omega_body_rad_s;
  if (const double angle_rad = turn.norm(); angle_rad > 0.0) {
    moved.T_world_body.rotation =
        state.T_world_body.rotation * Eigen::AngleAxisd(angle_rad, turn / angle_rad);
  }
  return moved;
}

Result<std::optional<std::vector<AircraftState>>> TruthWindow::around(
    std::int64_t t_ns,
    std::int64_t half_ns,
    std::int64_t step_ns,
    std::int64_t next_ns,
    const std::atomic<bool>* cancel) {
  const std::int64_t n = (half_ns + step_ns - 1) / step_ns;
  std::vector<AircraftState> states;
  states.reserve(static_cast<std::size_t>(2 * n + 1));
  for (std::int64_t j = -n; j <= n; ++j) {
    const std::int64_t at_ns = t_ns + j * step_ns;
    if (at_ns - step_ns < next_ns && next_ns < at_ns) {
      if (const auto next = at(next_ns, cancel); !next) return next.error();
    }
    auto state = at(std::max<std::int64_t>(at_ns, 0), cancel);
    if (!state) return state.error();
    if (*state && at_ns < 0) *state = extrapolated(**state, at_ns);
    if (!*state && j > 0) *state = extrapolated(states.back(), step_ns);
    if (!*state) return std::optional<std::vector<AircraftState>>();
    states.push_back(std::move(**state));
  }
  forget_before(t_ns - n * step_ns);
  return std::optional(std::move(states));
}

Result<std::optional<AircraftState>> TruthWindow::at(std::int64_t t_ns,
                                                     const std::atomic<bool>* cancel) {
  if (!known_.empty() && t_ns <= known_.back().t_ns) return std::optional(remembered(t_ns));
  if (ended_ns_ && t_ns >= *ended_ns_) return std::optional<AircraftState>();
  auto state = source_->state_at(t_ns, cancel);
  if (!state) return state;
  if (*state) {
    (*state)->t_ns = t_ns;
    known_.push_back(**state);
  } else {
    ended_ns_ = t_ns;
  }
  return state;
}

AircraftState TruthWindow::remembered(std::int64_t t_ns) const {
  const auto after = std::lower_bound(
      known_.begin(), known_.end(), t_ns, [](const AircraftState& state, std::int64_t t) {
        return state.t_ns < t;
      });
  if (after->t_ns == t_ns) return *after;
  if (after == known_.begin()) return extrapolated(*after, t_ns - after->t_ns);
  return between(*std::prev(after), *after, t_ns);
}

void TruthWindow::forget_before(std::int64_t t_ns) {
  while (known_.size() > 1 && known_[1].t_ns <= t_ns) known_.pop_front();
}

}  // namespace overfly::server
