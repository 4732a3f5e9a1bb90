#include "calibration/virtual/virtual_views.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <random>

#include "calibration/virtual/virtual_board.hpp"
#include "core/motion/pose.hpp"

namespace overfly::calibration {
namespace {

class ViewDraw {
 public:
  ViewDraw(const CameraModel& camera, const Board& board, std::uint64_t seed)
      : camera_(camera), board_(board), random_(seed) {}

  /// @param part  of the image, 0 to 8
  std::optional<Pose> view(int part) {
    constexpr int kTries = 400;
    for (int i = 0; i < kTries; ++i) {
      const auto pose = candidate(part);
      if (pose && shows_all(*pose)) return pose;
    }
    return std::nullopt;
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11U) * 0x1.0p-53);
  }

  std::optional<Pose> candidate(int part) {
    const PinholeCamera& c = camera_.pinhole();
    const double x = (part % 3 + uniform(0.0, 1.0)) / 3.0 * c.width_px - 0.5;
    const double y = (part / 3 + uniform(0.0, 1.0)) / 3.0 * c.height_px - 0.5;
    const double width_m = (board_.cols + 1 + 2 * kBoardBorder) * board_.square_m;
    const double distance_m = width_m * c.fx_px / (uniform(0.25, 0.6) * c.width_px);
    const double tilt = rad_from_deg(uniform(15.0, 45.0));
    const double azimuth = uniform(-kPi, kPi);
    const double turn = rad_from_deg(uniform(-30.0, 30.0));
    const auto ray = camera_.ray({x, y});
    if (!ray) return std::nullopt;
    const Eigen::Vector3d axis(std::cos(azimuth), std::sin(azimuth), 0.0);
    // Relative to the ray through the board's centre, so that it faces the camera everywhere.
    const Eigen::Quaterniond facing = shortest_rotation(Eigen::Vector3d::UnitZ(), *ray);
    const Eigen::Quaterniond R =
        facing * Eigen::AngleAxisd(tilt, axis) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d centre_m(
        0.5 * (board_.cols - 1) * board_.square_m, 0.5 * (board_.rows - 1) * board_.square_m, 0.0);
    return Pose{R, ray->normalized() * distance_m - R * centre_m};
  }

  /// The outline of the border, 16 points a side, lies within the image, and no point on the board
  /// is hidden by its edge.
  [[nodiscard]] bool shows_all(const Pose& T_camera_board) const {
    constexpr int kPoints = 16;
    const double low = -1.0 - kBoardBorder;
    const double high_x = board_.cols + kBoardBorder;
    const double high_y = board_.rows + kBoardBorder;
    for (int i = 0; i <= kPoints; ++i) {
      const double s = static_cast<double>(i) / kPoints;
      const double x = low + s * (high_x - low);
      const double y = low + s * (high_y - low);
      for (const Eigen::Vector2d& at : {Eigen::Vector2d(x, low),
                                        Eigen::Vector2d(x, high_y),
                                        Eigen::Vector2d(low, y),
                                        Eigen::Vector2d(high_x, y)}) {
        if (!inside(T_camera_board, at * board_.square_m)) return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool inside(const Pose& T_camera_board, const Eigen::Vector2d& at_m) const {
    const auto pixel = camera_.project(T_camera_board * Eigen::Vector3d(at_m.x(), at_m.y(), 0.0));
    const PinholeCamera& c = camera_.pinhole();
    constexpr double kEdgePx = 2.0;
    return pixel && pixel->minCoeff() > kEdgePx && pixel->x() < c.width_px - 1 - kEdgePx &&
           pixel->y() < c.height_px - 1 - kEdgePx;
  }

  const CameraModel& camera_;
  const Board& board_;
  std::mt19937_64 random_;
};

}  // namespace

std::vector<Pose> virtual_views(const CameraModel& camera,
                                const Board& board,
                                int count,
                                std::uint64_t seed) {
  ViewDraw draw(camera, board, seed);
  constexpr int kParts = 9;
  std::vector<Pose> views;
  int failed = 0;
  for (int part = 0; static_cast<int>(views.size()) < count && failed < kParts; ++part) {
    const auto view = draw.view(part % kParts);
    failed = view ? 0 : failed + 1;
    if (view) views.push_back(*view);
  }
  return views;
}

}  // namespace overfly::calibration
