#include "server/experiments/predict/walked_flight.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/cancel.hpp"
#include "core/time.hpp"

namespace overfly::server::predict {
namespace {

/// Of the path: a rotation at 200 deg/s turns by 4 deg.
constexpr std::int64_t kPathStepNs = 20'000'000;

}  // namespace

Result<WalkedFlight> WalkedFlight::walk(TruthSource& source,
                                        double step_s,
                                        double duration_s,
                                        const std::atomic<bool>* cancel) {
  const std::optional<std::int64_t> known_ns = source.duration_ns();
  const std::int64_t asked_ns = ns_from_s(duration_s);
  const std::int64_t end_ns = known_ns ? std::min(*known_ns, asked_ns) : asked_ns;
  if (end_ns > ns_from_s(kLongestFlightS)) {
    return Error{ErrorCode::kInvalidArgument,
                 "duration_s = " + std::to_string(end_ns / kNsPerS) +
                     ": at most 6 h are predicted; set duration_s and start_s to a part of the "
                     "flight"};
  }
  WalkedFlight flight;
  const double sparse_s = s_from_ns(end_ns) / static_cast<double>(kMostInstants);
  flight.every_ = std::max<std::int64_t>(
      1, (ns_from_s(std::max(step_s, sparse_s)) + kPathStepNs - 1) / kPathStepNs);
  for (std::int64_t t_ns = 0; t_ns <= end_ns + kNsPerS; t_ns += kPathStepNs) {
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "the prediction was cancelled"};
    const auto state = source.state_at(t_ns, cancel);
    if (!state) return state.error();
    if (!*state) break;
    flight.path_.push_back((*state)->T_world_body);
  }
  if (flight.path_.size() < 2) {
    return Error{ErrorCode::kInvalidArgument, "flight: it has no duration"};
  }
  flight.last_ = std::min(flight.path_.size() - 1, static_cast<std::size_t>(end_ns / kPathStepNs));
  flight.instants_ = flight.last_ / static_cast<std::size_t>(flight.every_) + 1;
  return flight;
}

std::int64_t WalkedFlight::instant_ns(std::size_t index) const {
  return static_cast<std::int64_t>(index) * every_ * kPathStepNs;
}

double WalkedFlight::step_s() const { return s_from_ns(every_ * kPathStepNs); }

double WalkedFlight::duration_s() const {
  return s_from_ns(static_cast<std::int64_t>(last_) * kPathStepNs);
}

Pose WalkedFlight::T_world_body_at(std::int64_t t_ns) const {
  const auto last = static_cast<double>(path_.size() - 1);
  const double at = std::max(static_cast<double>(t_ns) / static_cast<double>(kPathStepNs), 0.0);
  if (at >= last) {
    Pose pose = path_.back();
    pose.translation += (at - last) * (pose.translation - path_[path_.size() - 2].translation);
    return pose;
  }
  const auto before = static_cast<std::size_t>(at);
  return interpolate(path_[before], path_[before + 1], at - static_cast<double>(before));
}

std::vector<AircraftState> WalkedFlight::states_around(std::int64_t t_ns,
                                                       std::int64_t half_ns,
                                                       std::int64_t raster_ns) const {
  const std::int64_t n = (half_ns + raster_ns - 1) / raster_ns;
  std::vector<AircraftState> states(static_cast<std::size_t>(2 * n + 1));
  for (std::int64_t j = -n; j <= n; ++j) {
    AircraftState& state = states[static_cast<std::size_t>(j + n)];
    state.t_ns = t_ns + j * raster_ns;
    state.T_world_body = T_world_body_at(state.t_ns);
  }
  return states;
}

double WalkedFlight::length_m() const {
  double length = 0.0;
  for (std::size_t i = 1; i <= last_; ++i) {
    length += (path_[i].translation - path_[i - 1].translation).head<2>().norm();
  }
  return length;
}

}  // namespace overfly::server::predict
