#include "calibration/virtual/virtual_board.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "calibration/marker_dictionary.hpp"

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
        R_board_camera_(T_board_camera_.rotation.toRotationMatrix()) {
    if (!board.markers) return;
    marker_gap_ = board.marker_gap();
    marker_cells_per_square_ = (board.markers->bits + 2) / (1.0 - 2.0 * marker_gap_);
  }

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

  /// A part of the board with one colour: a square, or a cell of its marker. Points that share it
  /// share a colour.
  struct Part {
    int i = 0;
    int j = 0;
    int col = -1;  ///< of the cell, with the marker's border; -1 or `cells` outside it
    int row = -1;
    [[nodiscard]] bool operator==(const Part&) const = default;
  };

  [[nodiscard]] Part part_of(const BoardPoint& p) const {
    // Far from the board all is background.
    const auto number = [](double x) { return static_cast<int>(std::clamp(x, -1e6, 1e6)); };
    Part part{number(std::floor(p.x())), number(std::floor(p.y())), -1, -1};
    if (!board_.markers || !on_squares(part) || (part.i + part.j) % 2 == 0) return part;
    const auto cell_of = [&](double along) {
      const double cell = (along - marker_gap_) * marker_cells_per_square_;
      return std::clamp(static_cast<int>(std::floor(cell)), -1, board_.markers->bits + 2);
    };
    part.col = cell_of(p.x() - part.i);
    part.row = cell_of(p.y() - part.j);
    return part;
  }

  [[nodiscard]] bool on_squares(const Part& part) const {
    return part.i >= -1 && part.i < board_.cols && part.j >= -1 && part.j < board_.rows;
  }

  [[nodiscard]] float colour(const Part& part) const {
    if (!on_squares(part)) {
      const int low = -1 - kBoardBorder;
      const bool on_border = part.i >= low && part.i < board_.cols + kBoardBorder &&
                             part.j >= low && part.j < board_.rows + kBoardBorder;
      return on_border ? paint_.bright : paint_.background;
    }
    if ((part.i + part.j) % 2 == 0) return paint_.dark;
    return board_.markers ? marker_colour(part) : paint_.bright;
  }

  [[nodiscard]] float marker_colour(const Part& part) const {
    const int bits = board_.markers->bits;
    const int cells = bits + 2;
    const auto within = [](int cell, int count) { return cell >= 0 && cell < count; };
    if (!within(part.col, cells) || !within(part.row, cells)) return paint_.bright;
    const int col = part.col - 1;
    const int row = part.row - 1;
    if (!within(col, bits) || !within(row, bits)) return paint_.dark;
    const std::uint64_t marker = marker_cells(bits, board_.marker_of(part.i, part.j).value());
    return marker_cell(bits, marker, row, col) ? paint_.bright : paint_.dark;
  }

  [[nodiscard]] float pixel(const std::array<BoardPoint, 4>& corners) const {
    bool whole = true;
    for (const BoardPoint& corner : corners) {
      if (!corner.allFinite()) return paint_.background;
    }
    const Part part = part_of(corners[0]);
    for (const BoardPoint& corner : corners) whole = whole && part_of(corner) == part;
    return whole ? colour(part) : sampled(corners);
  }

  [[nodiscard]] float sampled(const std::array<BoardPoint, 4>& corners) const {
    float sum = 0.0F;
    for (const Eigen::Vector2d& s : hammersley()) {
      const BoardPoint p = (1.0 - s.y()) * ((1.0 - s.x()) * corners[0] + s.x() * corners[1]) +
                           s.y() * ((1.0 - s.x()) * corners[2] + s.x() * corners[3]);
      sum += colour(part_of(p));
    }
    return sum / kSamples;
  }

  const CameraModel& camera_;
  const Board& board_;
  const BoardPaint& paint_;
  Pose T_board_camera_;
  Eigen::Matrix3d R_board_camera_;
  double marker_gap_ = 0.0;               ///< from a square's edge, in squares
  double marker_cells_per_square_ = 0.0;  ///< with the marker's border
};

}  // namespace

RadianceImage draw_board(const CameraModel& camera,
                         const Board& board,
                         const Pose& T_camera_board,
                         const BoardPaint& paint) {
  return BoardDrawing(camera, board, T_camera_board, paint).draw();
}

}  // namespace overfly::calibration
