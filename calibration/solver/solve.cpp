#include "calibration/solver/solve.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <optional>

#include "core/algebra/decompositions.hpp"

namespace overfly::calibration {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// The camera and the poses between steps.
struct State {
  Eigen::VectorXd parameters;
  std::vector<Pose> T_camera_board;
};

/// Normal equations: camera block A, and for each view the pose block C and the coupling B.
struct Normals {
  Eigen::MatrixXd A;
  Eigen::VectorXd a;
  std::vector<Eigen::MatrixXd> B;
  std::vector<Matrix6> C;
  std::vector<Vector6> c;
};

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Pose moved(const Pose& pose, const Vector6& step) {
  const double angle = step.head<3>().norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle > 0.0) turn = Eigen::AngleAxisd(angle, Eigen::Vector3d(step.head<3>() / angle));
  return {(turn * pose.rotation).normalized(), pose.translation + step.tail<3>()};
}

class Problem {
 public:
  Problem(const Board& board,
          const LensChoice& lens,
          const std::vector<BoardView>& views,
          const PinholeCamera& size)
      : board_(board), lens_(lens), views_(views), size_(size) {}

  [[nodiscard]] CameraModel camera(const State& state) const {
    return camera_of(state.parameters, lens_, size_);
  }

  /// Sum of squared distances [px^2]; infinite if a corner is not in front of the camera or a focal
  /// length is not positive. Fills `normals` unless it is null.
  double evaluate(const State& state, Normals* normals) const {
    if (!(state.parameters.head<2>().minCoeff() > 0.0)) return kInfinity;
    if (normals != nullptr) *normals = empty();
    const CameraModel model = camera(state);
    double cost = 0.0;
    for (std::size_t v = 0; v < views_.size() && cost < kInfinity; ++v) {
      cost += evaluate_view(model, state.T_camera_board[v], v, normals);
    }
    return cost;
  }

  [[nodiscard]] ViewFitQuality quality(const State& state, std::size_t v) const {
    const CameraModel model = camera(state);
    const Eigen::Matrix3d R = state.T_camera_board[v].rotation.toRotationMatrix();
    ViewFitQuality quality;
    double sum = 0.0;
    for (const BoardCorner& corner : views_[v].corners) {
      const Eigen::Vector3d p = turned(R, corner.id) + state.T_camera_board[v].translation;
      const double squared =
          (project_with_derivatives(model, lens_, p).pixel - corner.pixel).squaredNorm();
      sum += squared;
      quality.max_px = std::max(quality.max_px, std::sqrt(squared));
    }
    quality.rms_px = std::sqrt(sum / static_cast<double>(views_[v].corners.size()));
    return quality;
  }

  [[nodiscard]] std::size_t corners() const {
    std::size_t count = 0;
    for (const BoardView& view : views_) count += view.corners.size();
    return count;
  }

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

 private:
  [[nodiscard]] Normals empty() const {
    const int n = lens_.parameters();
    return {Eigen::MatrixXd::Zero(n, n),
            Eigen::VectorXd::Zero(n),
            std::vector<Eigen::MatrixXd>(views_.size(), Eigen::MatrixXd::Zero(n, 6)),
            std::vector<Matrix6>(views_.size(), Matrix6::Zero()),
            std::vector<Vector6>(views_.size(), Vector6::Zero())};
  }

  [[nodiscard]] Eigen::Vector3d turned(const Eigen::Matrix3d& R, int id) const {
    const Eigen::Vector2d at_m = board_.corner_m(id);
    return R.col(0) * at_m.x() + R.col(1) * at_m.y();
  }

  double evaluate_view(const CameraModel& model,
                       const Pose& pose,
                       std::size_t v,
                       Normals* normals) const {
    const Eigen::Matrix3d R = pose.rotation.toRotationMatrix();
    double cost = 0.0;
    for (const BoardCorner& corner : views_[v].corners) {
      const Eigen::Vector3d arm = turned(R, corner.id);
      const Eigen::Vector3d p_camera = arm + pose.translation;
      if (!(p_camera.z() > 0.0)) return kInfinity;
      const ProjectedPoint projected = project_with_derivatives(model, lens_, p_camera);
      const Eigen::Vector2d residual = corner.pixel - projected.pixel;
      if (!residual.allFinite()) return kInfinity;
      cost += residual.squaredNorm();
      if (normals == nullptr) continue;
      Eigen::Matrix<double, 2, 6> J;
      J.leftCols<3>() = -projected.d_point * cross_matrix(arm);
      J.rightCols<3>() = projected.d_point;
      const auto& K = projected.d_parameters;
      normals->A += K.transpose() * K;
      normals->a += K.transpose() * residual;
      normals->B[v] += K.transpose() * J;
      normals->C[v] += J.transpose() * J;
      normals->c[v] += J.transpose() * residual;
    }
    return cost;
  }

  const Board& board_;
  const LensChoice& lens_;
  const std::vector<BoardView>& views_;
  const PinholeCamera& size_;
};

/// The camera block with the views eliminated, and its right-hand side.
struct Reduced {
  Eigen::MatrixXd S;
  Eigen::VectorXd s;
  std::vector<Matrix6> C_inverse;
};

/// @param damping  of the diagonals, relative
std::optional<Reduced> reduced(const Normals& normals, double damping) {
  Reduced r{normals.A, normals.a, {}};
  r.S.diagonal() *= 1.0 + damping;
  for (std::size_t v = 0; v < normals.C.size(); ++v) {
    Matrix6 C = normals.C[v];
    C.diagonal() *= 1.0 + damping;
    const Eigen::LDLT<Matrix6> factor(C);
    if (factor.info() != Eigen::Success || !factor.isPositive()) return std::nullopt;
    r.C_inverse.push_back(factor.solve(Matrix6::Identity()));
    r.S -= normals.B[v] * r.C_inverse[v] * normals.B[v].transpose();
    r.s -= normals.B[v] * r.C_inverse[v] * normals.c[v];
  }
  return r;
}

std::optional<State> stepped(const State& state, const Normals& normals, double damping) {
  const auto r = reduced(normals, damping);
  if (!r) return std::nullopt;
  const Eigen::VectorXd step = r->S.ldlt().solve(r->s);
  if (!step.allFinite()) return std::nullopt;
  State next = state;
  next.parameters += step;
  for (std::size_t v = 0; v < normals.C.size(); ++v) {
    const Vector6 pose_step = r->C_inverse[v] * (normals.c[v] - normals.B[v].transpose() * step);
    if (!pose_step.allFinite()) return std::nullopt;
    next.T_camera_board[v] = moved(state.T_camera_board[v], pose_step);
  }
  return next;
}

struct Minimum {
  State state;
  double cost = 0.0;
  int iterations = 0;
  bool converged = false;
};

Minimum minimise(const Problem& problem, State state) {
  constexpr int kMostIterations = 300;
  constexpr double kEnough = 1e-13;  // relative decrease of the cost
  Minimum minimum{std::move(state), 0.0, 0, false};
  Normals normals;
  minimum.cost = problem.evaluate(minimum.state, &normals);
  double damping = 1e-3;
  while (minimum.iterations < kMostIterations && !minimum.converged) {
    ++minimum.iterations;
    const auto next = stepped(minimum.state, normals, damping);
    const double cost = next ? problem.evaluate(*next, nullptr) : Problem::kInfinity;
    if (!(cost <= minimum.cost)) {
      damping *= 10.0;
      // No step of any length descends: the minimum, to the accuracy of the arithmetic.
      minimum.converged = damping > 1e12;
      continue;
    }
    minimum.converged = minimum.cost - cost <= kEnough * minimum.cost + 1e-18;
    minimum.state = *next;
    damping = std::max(damping * 0.1, 1e-12);
    minimum.cost = problem.evaluate(minimum.state, &normals);
  }
  return minimum;
}

/// Inverse of the reduced matrix; empty if it is singular when its diagonal is scaled to 1 by the
/// camera block's.
std::optional<Eigen::MatrixXd> covariance(const Problem& problem, const State& state) {
  Normals normals;
  problem.evaluate(state, &normals);
  const auto r = reduced(normals, 0.0);
  if (!r) return std::nullopt;
  const Eigen::VectorXd scale = normals.A.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * r->S * scale.asDiagonal();
  const auto eigen = symmetric_eigen(scaled);
  if (!eigen || !(eigen->values[0] > 1e-13)) return std::nullopt;
  return Eigen::MatrixXd(scale.asDiagonal() * eigen->vectors *
                         eigen->values.cwiseInverse().asDiagonal() * eigen->vectors.transpose() *
                         scale.asDiagonal());
}

Error undetermined(const std::string& reason) {
  return {
      ErrorCode::kInvalidArgument,
      "the views do not determine the camera (" + reason +
          "): show the board tilted by 20 to 45 deg in different directions, near the middle and "
          "near all edges of the image"};
}

}  // namespace

Result<Solution> solve(const Board& board,
                       const LensChoice& lens,
                       const std::vector<BoardView>& views,
                       const Guess& start) {
  const Problem problem(board, lens, views, start.camera.pinhole());
  const Minimum minimum =
      minimise(problem, {parameters_of(start.camera, lens), start.T_camera_board});
  if (!minimum.converged) return undetermined("the least squares do not converge");
  const auto unit_covariance = covariance(problem, minimum.state);
  if (!unit_covariance) return undetermined("their equations are singular");
  const auto corners = static_cast<double>(problem.corners());
  const double unknowns = lens.parameters() + 6.0 * static_cast<double>(views.size());
  if (!(2.0 * corners > unknowns)) return undetermined("too few corners");
  Solution solution;
  solution.camera = problem.camera(minimum.state);
  solution.T_camera_board = minimum.state.T_camera_board;
  for (std::size_t v = 0; v < views.size(); ++v) {
    solution.quality.push_back(problem.quality(minimum.state, v));
  }
  solution.rms_px = std::sqrt(minimum.cost / corners);
  solution.sigma_px = std::sqrt(minimum.cost / (2.0 * corners - unknowns));
  solution.unit_covariance = *unit_covariance;
  return solution;
}

}  // namespace overfly::calibration
