#include "flight/smoothing/time_offset.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/cancel.hpp"

namespace overfly::flight::smoothing {
namespace {

constexpr double kGravityMS2 = 9.80665;
constexpr double kFastestStepS = 0.1;
constexpr std::size_t kMaxPoints = 20'000;
constexpr double kSlowestMS = 5.0;
constexpr double kShortestS = 30.0;
constexpr double kCoarseStepS = 0.05;
constexpr double kFineStepS = 0.005;
constexpr double kLargestSigmaS = 0.2;
/// Larger lateral accelerations than this do not count more: gusts, slips, errors of positions.
constexpr double kLateralLimitMS2 = 5.0;

/// The acceleration of the path minus gravity, in north-east-down.
struct PathPoint {
  double t_s = 0.0;
  Eigen::Vector3d lift_ned_m_s2;
};

std::vector<PathPoint> fast_points(const PositionSpline& position,
                                   const RotationSpline& attitude,
                                   double step_s) {
  // Every offset must find attitudes, so that all are judged by the same points.
  const double begin_s = std::max(position.knots.begin_s, attitude.knots.begin_s + kMaxTimeOffsetS);
  const double end_s = std::min(position.knots.end_s(), attitude.knots.end_s() - kMaxTimeOffsetS);
  std::vector<PathPoint> points;
  for (double t_s = begin_s; t_s < end_s; t_s += step_s) {
    if (position.velocity_m_s(t_s).norm() < kSlowestMS) continue;
    const Eigen::Vector3d a = position.acceleration_m_s2(t_s);
    points.push_back({t_s, {a.y(), a.x(), -a.z() - kGravityMS2}});
  }
  return points;
}

struct Misfit {
  double mean_square = 0.0;
  double slope_mean_square = 0.0;  ///< of the derivative by the offset
};

double lateral_m_s2(const PathPoint& point, const RotationSpline& attitude, double offset_s) {
  const Eigen::Quaterniond R_ned_body = attitude.rotation(point.t_s - offset_s);
  return (R_ned_body.conjugate() * point.lift_ned_m_s2).y();
}

Misfit misfit_at(const std::vector<PathPoint>& points,
                 const RotationSpline& attitude,
                 double offset_s,
                 bool with_slope) {
  double sum = 0.0;
  std::vector<double> lateral(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    lateral[i] = lateral_m_s2(points[i], attitude, offset_s);
    sum += std::clamp(lateral[i], -kLateralLimitMS2, kLateralLimitMS2);
  }
  const double count = static_cast<double>(points.size());
  const double mean = sum / count;
  Misfit misfit;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double rest = std::clamp(lateral[i] - mean, -kLateralLimitMS2, kLateralLimitMS2);
    misfit.mean_square += rest * rest / count;
    if (!with_slope || std::abs(rest) >= kLateralLimitMS2) continue;
    const double slope = (lateral_m_s2(points[i], attitude, offset_s + kFineStepS) -
                          lateral_m_s2(points[i], attitude, offset_s - kFineStepS)) /
                         (2.0 * kFineStepS);
    misfit.slope_mean_square += slope * slope / count;
  }
  return misfit;
}

Error not_observable(const std::string& why) {
  return {ErrorCode::kUnsupported, "the time offset of the attitudes cannot be estimated: " + why};
}

}  // namespace

Result<TimeOffset> estimate_time_offset(const PositionSpline& position,
                                        const RotationSpline& attitude,
                                        const std::atomic<bool>* cancel) {
  const double span_s = position.knots.end_s() - position.knots.begin_s;
  const double step_s = std::max(kFastestStepS, span_s / static_cast<double>(kMaxPoints));
  const std::vector<PathPoint> points = fast_points(position, attitude, step_s);
  const double duration_s = static_cast<double>(points.size()) * step_s;
  if (duration_s < kShortestS) {
    return not_observable(std::to_string(static_cast<int>(duration_s)) +
                          " s are faster than 5 m/s, and 30 s are needed");
  }
  const auto search = [&](double from_s, double to_s, double by_s) -> Result<double> {
    double best_s = from_s;
    double least = -1.0;
    const int steps = static_cast<int>(std::lround((to_s - from_s) / by_s));
    for (int k = 0; k <= steps; ++k) {
      if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "smoothing was cancelled"};
      const double offset_s = from_s + k * by_s;
      const double square = misfit_at(points, attitude, offset_s, false).mean_square;
      if (least >= 0.0 && square >= least) continue;
      least = square;
      best_s = offset_s;
    }
    return best_s;
  };
  const Result<double> coarse = search(-kMaxTimeOffsetS, kMaxTimeOffsetS, kCoarseStepS);
  if (!coarse) return coarse.error();
  if (std::abs(*coarse) > kMaxTimeOffsetS - kCoarseStepS) {
    return not_observable("no offset within 2 s agrees best");
  }
  const Result<double> fine = search(*coarse - kCoarseStepS, *coarse + kCoarseStepS, kFineStepS);
  if (!fine) return fine.error();
  // The minimum of the parabola through three neighbours.
  const double before = misfit_at(points, attitude, *fine - kFineStepS, false).mean_square;
  const Misfit best = misfit_at(points, attitude, *fine, true);
  const double after = misfit_at(points, attitude, *fine + kFineStepS, false).mean_square;
  const double bend = before - 2.0 * best.mean_square + after;
  TimeOffset result{*fine, 0.0};
  if (bend > 0.0) result.offset_s += 0.5 * kFineStepS * (before - after) / bend;
  if (!(best.slope_mean_square > 0.0)) return not_observable("the flight has no turns");
  result.sigma_s = std::sqrt(best.mean_square / (best.slope_mean_square * duration_s));
  if (!(result.sigma_s <= kLargestSigmaS)) {
    return not_observable("the flight has too few turns (standard deviation " +
                          std::to_string(result.sigma_s) + " s)");
  }
  return result;
}

}  // namespace overfly::flight::smoothing
