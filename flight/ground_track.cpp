#include "flight/ground_track.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace overfly::flight {
namespace {

constexpr double kNodeS = 0.01;

struct QuadraturePoint {
  double at;  ///< in [0, 1]
  double weight;
};

/// Three-point Gauss-Legendre rule on [0, 1], exact to degree 5 (Abramowitz and Stegun 25.4.30).
const std::array<QuadraturePoint, 3> kGauss3{{{0.5 - 0.5 * 0.77459666924148337704, 5.0 / 18.0},
                                              {0.5, 8.0 / 18.0},
                                              {0.5 + 0.5 * 0.77459666924148337704, 5.0 / 18.0}}};

}  // namespace

double turn_rate_rad_s(double bank_rad, double speed_m_s) {
  return kGravityMS2 * std::tan(bank_rad) / speed_m_s;
}

GroundTrack::GroundTrack(BankProfile bank,
                         double speed_m_s,
                         const GroundSample& start,
                         double duration_s)
    : bank_(std::move(bank)), speed_m_s_(speed_m_s), duration_s_(duration_s) {
  const auto count = static_cast<std::size_t>(std::ceil(duration_s / kNodeS)) + 1;
  nodes_.reserve(count);
  nodes_.push_back(start);
  for (std::size_t i = 1; i < count; ++i) {
    nodes_.push_back(step(nodes_.back(), static_cast<double>(i - 1) * kNodeS, kNodeS));
  }
}

double GroundTrack::heading_after(const GroundSample& node, double node_s, double dt_s) const {
  double change_rad = 0.0;
  for (const QuadraturePoint& q : kGauss3) {
    const double bank_rad = bank_.at(node_s + q.at * dt_s).bank_rad;
    change_rad += q.weight * dt_s * turn_rate_rad_s(bank_rad, speed_m_s_);
  }
  return node.heading_rad + change_rad;
}

GroundSample GroundTrack::step(const GroundSample& node, double node_s, double dt_s) const {
  GroundSample next = node;
  for (const QuadraturePoint& q : kGauss3) {
    const double heading_rad = heading_after(node, node_s, q.at * dt_s);
    next.east_m += q.weight * dt_s * speed_m_s_ * std::sin(heading_rad);
    next.north_m += q.weight * dt_s * speed_m_s_ * std::cos(heading_rad);
  }
  next.heading_rad = heading_after(node, node_s, dt_s);
  return next;
}

GroundSample GroundTrack::at(double t_s) const {
  const double inside_s = std::clamp(t_s, 0.0, duration_s_);
  const auto index = std::min(static_cast<std::size_t>(inside_s / kNodeS), nodes_.size() - 1);
  const double node_s = static_cast<double>(index) * kNodeS;
  GroundSample sample = step(nodes_[index], node_s, inside_s - node_s);
  sample.heading_rate_rad_s = turn_rate_rad_s(bank_.at(inside_s).bank_rad, speed_m_s_);
  const double beyond_m = (t_s - inside_s) * speed_m_s_;
  if (beyond_m == 0.0) return sample;
  sample.heading_rate_rad_s = 0.0;
  sample.east_m += beyond_m * std::sin(sample.heading_rad);
  sample.north_m += beyond_m * std::cos(sample.heading_rad);
  return sample;
}

}  // namespace overfly::flight
