#include "calibration/virtual/virtual_board.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace overfly::calibration {
namespace {

/// Place on the board, in squares from the first inner corner; NaN where a ray misses its plane.
using BoardPoint = Eigen::Vector2d;

constexpr int kSamples = 256;

/// Points i / n and the bit-reversed i: any interval of x or of y holds its share of them.
const std::array<Eigen::Vector2d, kSamples>& hammersley() {
  static const std::array<Eigen::Vector2d, kSamples> points = [] {
    std::array<Eigen::Vector2d, kSamples> made;
    for (unsigned i = 0; i < kSamples; ++i) {
      unsigned reversed = 0;
      for (unsigned bit = 0; bit < 8; ++bit) reversed |= ((i >> bit) & 1U) << (7U - bit);
      made[i] = {(i + 0.5) / kSamples, (reversed + 0.5) / kSamples};
    }
    return made;
  }();
  return points;
}

class BoardDrawing {
 public:
  BoardDrawing(const CameraModel& camera,
               const Board& board,
               const Pose& T_camera_board,
               const BoardPaint& paint)
      : camera_(camera),
        board_(board),
        paint_(paint),
        T_board_camera_(T_camera_board.inverse()),
        R_board_camera_(T_board_camera_.rotation.toRotationMatrix()) {}

  RadianceImage draw() const {
    const PinholeCamera& size = camera_.pinhole();
    RadianceImage image(size.width_px, size.height_px, 1, paint_.background);
    std::vector<BoardPoint> above = lattice_row(0);
    for (int y = 0; y < size.height_px; ++y) {
      std::vector<BoardPoint> below = lattice_row(y + 1);
      for (int x = 0; x < size.width_px; ++x) {
        const auto i = static_cast<std::size_t>(x);
        image.at(x, y) = pixel({above[i], above[i + 1], below[i], below[i + 1]});
      }
      above = std::move(below);
    }
    return image;
  }

 private:
  /// The board under the corners of the pixels along the upper edge of row y.
  [[nodiscard]] std::vector<BoardPoint> lattice_row(int y) const {
    std::vector<BoardPoint> row;
    for (int x = 0; x <= camera_.pinhole().width_px; ++x) row.push_back(cast({x - 0.5, y - 0.5}));
    return row;
  }

  [[nodiscard]] BoardPoint cast(const Eigen::Vector2d& pixel) const {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const auto ray = camera_.ray(pixel);
    if (!ray) return {kNan, kNan};
    const Eigen::Vector3d direction = R_board_camera_ * *ray;
    const Eigen::Vector3d& origin = T_board_camera_.translation;
    const double range = -origin.z() / direction.z();
    if (!(range > 0.0) || !std::isfinite(range)) return {kNan, kNan};
    return (origin + range * direction).head<2>() / board_.square_m;
  }

  /// Squares are numbered from -1, so that square (0, 0) lies between the inner corners (0, 0) and
  /// (1, 1). Points that share a square share a colour.
  [[nodiscard]] float colour(double i, double j) const {
    const bool on_squares = i >= -1.0 && i < board_.cols && j >= -1.0 && j < board_.rows;
    if (on_squares) return std::fmod(std::abs(i + j), 2.0) < 0.5 ? paint_.dark : paint_.bright;
    const double most = kBoardBorder;
    const bool on_border =
        i >= -1.0 - most && i < board_.cols + most && j >= -1.0 - most && j < board_.rows + most;
    return on_border ? paint_.bright : paint_.background;
  }

  [[nodiscard]] float pixel(const std::array<BoardPoint, 4>& corners) const {
    const double i = std::floor(corners[0].x());
    const double j = std::floor(corners[0].y());
    bool whole = true;
    for (const BoardPoint& corner : corners) {
      if (!corner.allFinite()) return paint_.background;
      whole = whole && std::floor(corner.x()) == i && std::floor(corner.y()) == j;
    }
    return whole ? colour(i, j) : sampled(corners);
  }

  [[nodiscard]] float sampled(const std::array<BoardPoint, 4>& corners) const {
    float sum = 0.0F;
    for (const Eigen::Vector2d& s : hammersley()) {
      const BoardPoint p = (1.0 - s.y()) * ((1.0 - s.x()) * corners[0] + s.x() * corners[1]) +
                           s.y() * ((1.0 - s.x()) * corners[2] + s.x() * corners[3]);
      sum += colour(std::floor(p.x()), std::floor(p.y()));
    }
    return sum / kSamples;
  }

  const CameraModel& camera_;
  const Board& board_;
  const BoardPaint& paint_;
  Pose T_board_camera_;
  Eigen::Matrix3d R_board_camera_;
};

}  // namespace

RadianceImage draw_board(const CameraModel& camera,
                         const Board& board,
                         const Pose& T_camera_board,
                         const BoardPaint& paint) {
  return BoardDrawing(camera, board, T_camera_board, paint).draw();
}

}  // namespace overfly::calibration
