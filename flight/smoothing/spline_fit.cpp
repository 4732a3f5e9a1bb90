#include "flight/smoothing/spline_fit.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/cancel.hpp"
#include "flight/smoothing/fit_windows.hpp"
#include "flight/smoothing/spline_terms.hpp"

namespace overfly::flight::smoothing {
namespace {

constexpr double kWindowS = 60.0;
constexpr double kOverlapS = 6.0;
/// Residuals beyond this many standard deviations count linearly.
constexpr double kHuberSigmas = 2.0;

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

Status solve_window(ceres::Problem& problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Does not depend on the number of processors, as a BLAS may.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = 30;
  options.initial_trust_region_radius = 1e8;
  options.function_tolerance = 1e-8;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (summary.IsSolutionUsable()) return {};
  return Error{ErrorCode::kInternal, "the fit of the flight failed: " + summary.message};
}

/// The indices of the samples whose segment has all its control points in a window.
template <typename Sample>
std::pair<std::size_t, std::size_t> samples_in(std::span<const Sample> samples,
                                               const SplineKnots& knots,
                                               const FitWindow& window) {
  const auto first_with = [&](std::size_t segment) {
    const auto found =
        std::partition_point(samples.begin(), samples.end(), [&](const Sample& sample) {
          return knots.place(sample.t_s).segment < segment;
        });
    return static_cast<std::size_t>(found - samples.begin());
  };
  const std::size_t segments_end = window.end < 3 ? 0 : window.end - 3;
  return {first_with(window.first), first_with(std::max(segments_end, window.first))};
}

/// Solves every window and keeps the middle of each.
/// @param fill  adds a window's terms to a problem
template <typename Control, typename Fill>
Status solve_windows(const SplineKnots& knots,
                     std::vector<Control>& control,
                     const std::atomic<bool>* cancel,
                     const FitProgress& progress,
                     const Fill& fill) {
  const auto points = [&](double duration_s) {
    return static_cast<std::size_t>(std::ceil(duration_s / knots.spacing_s));
  };
  const std::vector<Control> start = control;
  for (const FitWindow& window : fit_windows(control.size(), points(kWindowS), points(kOverlapS))) {
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "smoothing was cancelled"};
    if (progress) {
      progress(static_cast<double>(window.keep_first) / static_cast<double>(control.size()));
    }
    std::vector<Control> solved(start.begin() + static_cast<std::ptrdiff_t>(window.first),
                                start.begin() + static_cast<std::ptrdiff_t>(window.end));
    ceres::Problem problem(problem_options());
    fill(window, solved, problem);
    if (Status status = solve_window(problem); !status) return status;
    for (std::size_t i = window.keep_first; i < window.keep_end; ++i) {
      control[i] = solved[i - window.first];
    }
  }
  return {};
}

/// Calls `put(i, sample before, sample after, part)` for every control point's own time.
template <typename Sample, typename Put>
void interpolate_control(std::span<const Sample> samples,
                         const SplineKnots& knots,
                         const Put& put) {
  std::size_t after = 1;
  for (std::size_t i = 0; i < knots.control_points(); ++i) {
    const double t_s = knots.begin_s + (static_cast<double>(i) - 1.0) * knots.spacing_s;
    while (after + 1 < samples.size() && samples[after].t_s < t_s) ++after;
    const Sample& a = samples[after - 1];
    const Sample& b = samples[after];
    put(i, a, b, std::clamp((t_s - a.t_s) / (b.t_s - a.t_s), 0.0, 1.0));
  }
}

}  // namespace

Result<PositionSpline> fit_positions(std::span<const PositionSample> samples,
                                     const SplineKnots& knots,
                                     const PositionNoise& noise,
                                     double psd,
                                     const std::atomic<bool>* cancel,
                                     const FitProgress& progress) {
  PositionSpline spline{knots, std::vector<Eigen::Vector3d>(knots.control_points())};
  interpolate_control(
      samples, knots, [&](std::size_t i, const auto& a, const auto& b, double part) {
        spline.control_m[i] = (1.0 - part) * a.p_world_m + part * b.p_world_m;
      });
  const Eigen::Vector3d scale(
      1.0 / noise.horizontal_m, 1.0 / noise.horizontal_m, 1.0 / noise.vertical_m);
  // The third derivative is constant in a segment: (-1, 3, -3, 1) / h^3.
  const double h_s = knots.spacing_s;
  const Eigen::Vector3d jerk_scale =
      Eigen::Vector3d::Constant(std::sqrt(h_s / psd) / (h_s * h_s * h_s));
  ceres::HuberLoss loss(kHuberSigmas);
  const auto fill = [&](const FitWindow& window,
                        std::vector<Eigen::Vector3d>& solved,
                        ceres::Problem& problem) {
    const auto add = [&](ceres::CostFunction* term, ceres::LossFunction* shape, std::size_t at) {
      problem.AddResidualBlock(term,
                               shape,
                               solved[at].data(),
                               solved[at + 1].data(),
                               solved[at + 2].data(),
                               solved[at + 3].data());
    };
    for (std::size_t at = 0; at + 3 < solved.size(); ++at) {
      add(new LinearTerm({-1, 3, -3, 1}, jerk_scale, Eigen::Vector3d::Zero()), nullptr, at);
    }
    const auto [first, end] = samples_in(samples, knots, window);
    for (std::size_t k = first; k < end; ++k) {
      const SplineKnots::Place place = knots.place(samples[k].t_s);
      add(new LinearTerm(spline_weights(place.u), scale, samples[k].p_world_m),
          &loss,
          place.segment - window.first);
    }
  };
  if (Status status = solve_windows(knots, spline.control_m, cancel, progress, fill); !status) {
    return status.error();
  }
  return spline;
}

Result<RotationSpline> fit_rotations(std::span<const AttitudeSample> samples,
                                     const SplineKnots& knots,
                                     double noise_rad,
                                     double psd,
                                     const std::atomic<bool>* cancel,
                                     const FitProgress& progress) {
  RotationSpline spline{knots, std::vector<Eigen::Quaterniond>(knots.control_points())};
  interpolate_control(
      samples, knots, [&](std::size_t i, const auto& a, const auto& b, double part) {
        spline.control[i] = a.R_ned_body.slerp(part, b.R_ned_body).normalized();
      });
  const double h_s = knots.spacing_s;
  const double prior_scale = std::sqrt(h_s / psd) / (h_s * h_s);
  ceres::HuberLoss loss(kHuberSigmas);
  ceres::EigenQuaternionManifold manifold;
  const auto fill = [&](const FitWindow& window,
                        std::vector<Eigen::Quaterniond>& solved,
                        ceres::Problem& problem) {
    const auto data = [&](std::size_t i) { return solved[i].coeffs().data(); };
    for (std::size_t i = 0; i < solved.size(); ++i) {
      problem.AddParameterBlock(data(i), 4, &manifold);
    }
    for (std::size_t i = 0; i + 2 < solved.size(); ++i) {
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<AngularAccelerationTerm, 3, 4, 4, 4>(
                                   new AngularAccelerationTerm{prior_scale}),
                               nullptr,
                               data(i),
                               data(i + 1),
                               data(i + 2));
    }
    const auto [first, end] = samples_in(samples, knots, window);
    for (std::size_t k = first; k < end; ++k) {
      const SplineKnots::Place place = knots.place(samples[k].t_s);
      const std::size_t at = place.segment - window.first;
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<RotationTerm, 3, 4, 4, 4, 4>(new RotationTerm{
              cumulative_weights(place.u), samples[k].R_ned_body, 1.0 / noise_rad}),
          &loss,
          data(at),
          data(at + 1),
          data(at + 2),
          data(at + 3));
    }
  };
  if (Status status = solve_windows(knots, spline.control, cancel, progress, fill); !status) {
    return status.error();
  }
  for (Eigen::Quaterniond& control : spline.control) control.normalize();
  return spline;
}

}  // namespace overfly::flight::smoothing
