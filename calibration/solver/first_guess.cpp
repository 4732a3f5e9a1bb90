#include "calibration/solver/first_guess.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "calibration/solver/plane_homography.hpp"

namespace overfly::calibration {
namespace {

/// Candidates from a fifth of the image's longer side (136 deg across it for a pinhole) to ten
/// times the side, 5 % apart.
constexpr double kShortest = 0.2;
constexpr double kStep = 1.05;
constexpr int kCandidates = 81;

/// Point of the ideal image plane, without coefficients. Empty for a direction 86 deg or more from
/// the axis.
std::optional<Eigen::Vector2d> ideal_point(const CameraModel& camera,
                                           const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d straight = camera.pinhole().ray(pixel).head<2>();
  if (camera.distortion().model != DistortionModel::kEquidistant) return straight;
  const double theta = straight.norm();  // r = theta (Kannala, Brandt 2006, equation 6)
  constexpr double kMostTheta = 1.5;
  if (theta > kMostTheta) return std::nullopt;
  return theta < 1e-9 ? straight : Eigen::Vector2d(straight * (std::tan(theta) / theta));
}

struct ViewFit {
  Pose T_camera_board;
  double squared_error = 0.0;  ///< [px^2]
};

std::optional<ViewFit> fit(const Board& board, const CameraModel& camera, const BoardView& view) {
  std::vector<PlanePair> pairs;
  for (const BoardCorner& corner : view.corners) {
    const auto ideal = ideal_point(camera, corner.pixel);
    if (!ideal) return std::nullopt;
    pairs.push_back({board.corner_m(corner.id), *ideal});
  }
  const auto H = homography(pairs);
  if (!H) return std::nullopt;
  const auto pose = plane_pose(*H);
  if (!pose) return std::nullopt;
  ViewFit fitted{*pose, 0.0};
  const Eigen::Matrix3d R = pose->rotation.toRotationMatrix();
  for (const BoardCorner& corner : view.corners) {
    const Eigen::Vector2d at_m = board.corner_m(corner.id);
    const Eigen::Vector3d p_camera = R.col(0) * at_m.x() + R.col(1) * at_m.y() + pose->translation;
    const auto pixel = camera.project(p_camera);
    if (!pixel) return std::nullopt;
    fitted.squared_error += (*pixel - corner.pixel).squaredNorm();
  }
  return fitted;
}

}  // namespace

std::optional<Guess> first_guess(const Board& board,
                                 const PinholeCamera& size,
                                 const LensChoice& lens,
                                 const std::vector<BoardView>& views) {
  std::optional<Guess> best;
  double least = std::numeric_limits<double>::infinity();
  double f_px = kShortest * std::max(size.width_px, size.height_px);
  for (int i = 0; i < kCandidates; ++i, f_px *= kStep) {
    Eigen::VectorXd parameters = Eigen::VectorXd::Zero(lens.parameters());
    parameters.head<4>() << f_px, f_px, 0.5 * (size.width_px - 1), 0.5 * (size.height_px - 1);
    Guess guess{camera_of(parameters, lens, size), {}};
    double squared_error = 0.0;
    for (const BoardView& view : views) {
      const auto fitted = fit(board, guess.camera, view);
      if (!fitted) break;
      guess.T_camera_board.push_back(fitted->T_camera_board);
      squared_error += fitted->squared_error;
    }
    if (guess.T_camera_board.size() < views.size() || !(squared_error < least)) continue;
    least = squared_error;
    best = std::move(guess);
  }
  return best;
}

}  // namespace overfly::calibration
