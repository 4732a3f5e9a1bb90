#include "odometry/adjustment/bundle.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <numeric>
#include <vector>

#include "odometry/adjustment/bundle_terms.hpp"

namespace overfly::odometry {
namespace {

ceres::Solver::Options solver_options(int max_iterations,
                                      std::shared_ptr<ceres::ParameterBlockOrdering> ordering) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = std::move(ordering);
  options.max_num_iterations = max_iterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-4;
  return options;
}

/// The terms of all sights, in memory in the order of the points, in which the solver evaluates
/// them.
struct Terms {
  Terms(const PinholeCamera& camera, const std::vector<Bundle::Sight>& sights)
      : of_sight(sights.size()) {
    std::vector<std::size_t> order(sights.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return sights[a].point < sights[b].point;
    });
    for (const std::size_t i : order) {
      of_sight[i] = &terms.emplace_back(camera, sights[i].pixel, sights[i].sigma_px);
    }
  }

  std::deque<Reprojection> terms;
  std::vector<Reprojection*> of_sight;
};

}  // namespace

double adjust(const PinholeCamera& camera, Bundle& bundle, const BundleOptions& options) {
  std::vector<PoseBlock> blocks(bundle.cameras.size());
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.disable_all_safety_checks = true;
  PoseManifold manifold;
  ceres::HuberLoss loss(options.huber);
  Terms terms(camera, bundle.sights);
  ceres::Problem problem(ownership);
  const auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    store(bundle.cameras[i].T_camera_vo, blocks[i].data());
    problem.AddParameterBlock(blocks[i].data(), 7, &manifold);
    if (bundle.cameras[i].fixed) problem.SetParameterBlockConstant(blocks[i].data());
    ordering->AddElementToGroup(blocks[i].data(), 1);
  }
  for (Eigen::Vector3d& point : bundle.points_vo) {
    problem.AddParameterBlock(point.data(), 3);
    ordering->AddElementToGroup(point.data(), 0);
  }
  for (std::size_t i = 0; i < bundle.sights.size(); ++i) {
    const Bundle::Sight& sight = bundle.sights[i];
    problem.AddResidualBlock(terms.of_sight[i],
                             &loss,
                             blocks[static_cast<std::size_t>(sight.camera)].data(),
                             bundle.points_vo[static_cast<std::size_t>(sight.point)].data());
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options.max_iterations, ordering), &problem, &summary);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (bundle.cameras[i].fixed) continue;
    Pose& pose = bundle.cameras[i].T_camera_vo;
    pose = pose_of(blocks[i].data());
    pose.rotation.normalize();
  }
  if (!summary.IsSolutionUsable()) return std::numeric_limits<double>::infinity();
  const double count = std::max<double>(1.0, 2.0 * static_cast<double>(bundle.sights.size()));
  return std::sqrt(2.0 * summary.final_cost / count);
}

}  // namespace overfly::odometry
