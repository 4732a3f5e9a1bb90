#include "flight/autopilot/smooth_ground.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace overfly::autopilot {
namespace {

std::array<double, 4> cubic_weights(double t) {
  const double s = 1.0 - t;
  return {s * s * s / 6.0,
          (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
          (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0,
          t * t * t / 6.0};
}

}  // namespace

SmoothGround::SmoothGround(std::shared_ptr<const HeightQuery> ground, double spacing_m)
    : ground_(std::move(ground)), spacing_m_(spacing_m) {}

double SmoothGround::node_m(std::int32_t column, std::int32_t row) {
  const std::uint64_t key =
      (static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32U) |
      static_cast<std::uint32_t>(row);
  if (const auto known = nodes_m_.find(key); known != nodes_m_.end()) return known->second;
  constexpr std::array kWeights{0.25, 0.5, 0.25};
  double sum_m = 0.0;
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      sum_m += kWeights[i + 1] * kWeights[j + 1] *
               ground_->ground_up_m(spacing_m_ * (column + 0.5 * i), spacing_m_ * (row + 0.5 * j));
    }
  }
  nodes_m_.emplace(key, sum_m);
  return sum_m;
}

double SmoothGround::up_m(const Eigen::Vector2d& position_m) {
  const Eigen::Vector2d at = position_m / spacing_m_;
  if (!at.allFinite() || at.cwiseAbs().maxCoeff() >= 1e8) return std::nan("");
  const Eigen::Vector2d cell = at.array().floor();
  const std::array east = cubic_weights(at.x() - cell.x());
  const std::array north = cubic_weights(at.y() - cell.y());
  const auto column = static_cast<std::int32_t>(cell.x());
  const auto row = static_cast<std::int32_t>(cell.y());
  double sum_m = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) sum_m += east[i] * north[j] * node_m(column + i - 1, row + j - 1);
  }
  return sum_m;
}

}  // namespace overfly::autopilot
