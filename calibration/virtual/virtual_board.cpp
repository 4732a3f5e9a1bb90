#include "calibration/virtual/virtual_board.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "calibration/marker_dictionary.hpp"

namespace overfly::calibration {
namespace {

/// Place on the board, in squares from the first inner corner; NaN where a ray misses its plane.
using BoardPoint = Eigen::Vector2d;

constexpr std::size_t kSamples = 256;

/// Places in a pixel, in [0, 1].
struct Samples {
  std::array<double, kSamples> right;
  std::array<double, kSamples> down;
};

/// Points i / n and the bit-reversed i: any interval of either holds its share of them.
const Samples& hammersley() {
  static const Samples samples = [] {
    Samples made;
    for (unsigned i = 0; i < kSamples; ++i) {
      unsigned reversed = 0;
      for (unsigned bit = 0; bit < 8; ++bit) reversed |= ((i >> bit) & 1U) << (7U - bit);
      made.right[i] = (i + 0.5) / kSamples;
      made.down[i] = (reversed + 0.5) / kSamples;
    }
    return made;
  }();
  return samples;
}

/// std::floor, which is a call without SSE4.1. @pre |x| < 2^31
int floor_of(double x) {
  const int truncated = static_cast<int>(x);
  return truncated - (truncated > x ? 1 : 0);
}

/// Appends the rays of the pixels' corners along the upper edge of row y, as BoardPainter keeps
/// them.
void append_rays(const CameraModel& camera, int y, std::vector<Eigen::Vector2d>& rays) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (int x = 0; x <= camera.pinhole().width_px; ++x) {
    const auto ray = camera.ray({x - 0.5, y - 0.5});
    rays.emplace_back(ray ? ray->x() : kNan, ray ? ray->y() : kNan);
  }
}

class BoardDrawing {
 public:
  /// @param rays  as BoardPainter keeps them
  BoardDrawing(const CameraModel& camera,
               const std::vector<Eigen::Vector2d>& rays,
               const Board& board,
               const Pose& T_camera_board,
               const BoardPaint& paint)
      : camera_(camera),
        rays_(rays),
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
    std::vector<Corner> above = lattice_row(0);
    for (int y = 0; y < size.height_px; ++y) {
      std::vector<Corner> below = lattice_row(y + 1);
      for (int x = 0; x < size.width_px; ++x) {
        const auto i = static_cast<std::size_t>(x);
        image.at(x, y) = pixel(above[i], above[i + 1], below[i], below[i + 1]);
      }
      above = std::move(below);
    }
    return image;
  }

 private:
  [[nodiscard]] BoardPoint cast(const Eigen::Vector2d& ray) const {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const Eigen::Vector3d direction = R_board_camera_ * ray.homogeneous();
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

  /// The corner of up to four pixels.
  struct Corner {
    BoardPoint p;
    Part part;
    bool on_plane = false;
  };

  /// The board under the corners of the pixels along the upper edge of row y.
  [[nodiscard]] std::vector<Corner> lattice_row(int y) const {
    std::vector<Corner> row(static_cast<std::size_t>(camera_.pinhole().width_px) + 1);
    std::vector<Eigen::Vector2d> found;
    if (rays_.empty()) append_rays(camera_, y, found);
    const Eigen::Vector2d* const rays =
        rays_.empty() ? found.data() : &rays_[static_cast<std::size_t>(y) * row.size()];
    for (std::size_t x = 0; x < row.size(); ++x) {
      row[x].p = cast(rays[x]);
      row[x].on_plane = row[x].p.allFinite();
      if (row[x].on_plane) row[x].part = part_of(row[x].p);
    }
    return row;
  }

  [[nodiscard]] Part part_of(const BoardPoint& p) const {
    // Far from the board all is background.
    const auto number = [](double x) { return floor_of(std::clamp(x, -1e6, 1e6)); };
    Part part{number(p.x()), number(p.y()), -1, -1};
    if (!board_.markers || !on_squares(part) || (part.i + part.j) % 2 == 0) return part;
    const auto cell_of = [&](double along) {
      const int cell = floor_of((along - marker_gap_) * marker_cells_per_square_);
      return std::clamp(cell, -1, board_.markers->bits + 2);
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

  [[nodiscard]] float pixel(const Corner& a,
                            const Corner& b,
                            const Corner& c,
                            const Corner& d) const {
    if (!a.on_plane || !b.on_plane || !c.on_plane || !d.on_plane) return paint_.background;
    const bool whole = a.part == b.part && a.part == c.part && a.part == d.part;
    return whole ? colour(a.part) : sampled({a.p, b.p, c.p, d.p});
  }

  [[nodiscard]] float sampled(const std::array<BoardPoint, 4>& corners) const {
    BoardPoint low = corners[0];
    BoardPoint high = corners[0];
    for (const BoardPoint& corner : corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    const auto columns = lines_between(low.x(), high.x());
    const auto rows = lines_between(low.y(), high.y());
    if (!columns || !rows) {
      return mean_of_samples(corners, [&](double x, double y) { return colour(part_of({x, y})); });
    }
    std::array<std::array<float, kMostLines + 1>, kMostLines + 1> colours;
    for (std::size_t row = 0; row <= rows->count; ++row) {
      for (std::size_t column = 0; column <= columns->count; ++column) {
        colours[row][column] = colour(part_of({columns->middle(column), rows->middle(row)}));
      }
    }
    return mean_of_samples(
        corners, [&](double x, double y) { return colours[rows->below(y)][columns->below(x)]; });
  }

  /// @param colour_at  of a place on the board, in squares
  template <typename ColourAt>
  [[nodiscard]] static float mean_of_samples(const std::array<BoardPoint, 4>& corners,
                                             const ColourAt& colour_at) {
    const Samples& samples = hammersley();
    // One after the other, so that the compiler computes several samples at once.
    std::array<double, kSamples> x;
    std::array<double, kSamples> y;
    const auto mix =
        [&](double a, double b, double c, double d, std::array<double, kSamples>& mixed) {
          for (std::size_t i = 0; i < kSamples; ++i) {
            const double right = samples.right[i];
            const double down = samples.down[i];
            mixed[i] = (1.0 - down) * ((1.0 - right) * a + right * b) +
                       down * ((1.0 - right) * c + right * d);
          }
        };
    mix(corners[0].x(), corners[1].x(), corners[2].x(), corners[3].x(), x);
    mix(corners[0].y(), corners[1].y(), corners[2].y(), corners[3].y(), y);
    float sum = 0.0F;
    for (std::size_t i = 0; i < kSamples; ++i) sum += colour_at(x[i], y[i]);
    return sum / kSamples;
  }

  static constexpr std::size_t kMostLines = 4;

  /// Where the colour may change along one axis, within an interval: edges of squares and, on
  /// boards with markers, of their cells.
  struct Lines {
    double low = 0.0;
    double high = 0.0;
    std::array<double, kMostLines> at{};  ///< ascending
    std::size_t count = 0;

    [[nodiscard]] std::size_t below(double x) const {
      std::size_t lines = 0;
      for (std::size_t i = 0; i < count; ++i) lines += x >= at[i] ? 1 : 0;
      return lines;
    }
    /// Of the part after so many lines.
    [[nodiscard]] double middle(std::size_t lines) const {
      return 0.5 * ((lines == 0 ? low : at[lines - 1]) + (lines == count ? high : at[lines]));
    }
  };

  /// None if they are too many.
  [[nodiscard]] std::optional<Lines> lines_between(double low, double high) const {
    if (std::max(-low, high) > 1e6 || high - low > kMostLines) return std::nullopt;
    Lines lines{low, high};
    const auto add = [&](double at) {
      if (at <= low || at > high) return true;
      if (lines.count == kMostLines) return false;
      lines.at[lines.count++] = at;
      return true;
    };
    const int cells = board_.markers ? board_.markers->bits + 2 : -1;
    for (int square = floor_of(low); square <= high; ++square) {
      if (!add(square)) return std::nullopt;
      for (int cell = 0; cell <= cells; ++cell) {
        if (!add(square + marker_gap_ + cell / marker_cells_per_square_)) return std::nullopt;
      }
    }
    return lines;
  }

  const CameraModel& camera_;
  const std::vector<Eigen::Vector2d>& rays_;
  const Board& board_;
  const BoardPaint& paint_;
  Pose T_board_camera_;
  Eigen::Matrix3d R_board_camera_;
  double marker_gap_ = 0.0;               ///< from a square's edge, in squares
  double marker_cells_per_square_ = 0.0;  ///< with the marker's border
};

}  // namespace

BoardPainter::BoardPainter(const CameraModel& camera) : camera_(camera) {
  const PinholeCamera& size = camera.pinhole();
  const std::size_t count = (static_cast<std::size_t>(size.width_px) + 1) *
                            (static_cast<std::size_t>(size.height_px) + 1);
  if (count > kMostKeptRays) return;
  rays_.reserve(count);
  for (int y = 0; y <= size.height_px; ++y) append_rays(camera_, y, rays_);
}

RadianceImage BoardPainter::draw(const Board& board,
                                 const Pose& T_camera_board,
                                 const BoardPaint& paint) const {
  return BoardDrawing(camera_, rays_, board, T_camera_board, paint).draw();
}

}  // namespace overfly::calibration
