#include "calibration/detection/detect_board.hpp"

#include "calibration/detection/detect_charuco.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

namespace overfly::calibration {
namespace {

constexpr int kLeastSidePx = 16;
constexpr int kMostSidePx = 16384;

Eigen::Vector2d at(const std::vector<cv::Point2f>& corners, int id) {
  const cv::Point2f& corner = corners[static_cast<std::size_t>(id)];
  return {corner.x, corner.y};
}

/// Grey level in the middle of the square whose first corner is `id`: the mean over a ninth of its
/// area, sampled along its diagonals' grid.
double square_level(const Image& image,
                    const std::vector<cv::Point2f>& corners,
                    const Board& board,
                    int id) {
  const Eigen::Vector2d a = at(corners, id);
  const Eigen::Vector2d b = at(corners, id + 1);
  const Eigen::Vector2d c = at(corners, id + board.cols);
  const Eigen::Vector2d d = at(corners, id + board.cols + 1);
  double sum = 0.0;
  int count = 0;
  for (const double u : {1.0 / 3.0, 0.5, 2.0 / 3.0}) {
    for (const double v : {1.0 / 3.0, 0.5, 2.0 / 3.0}) {
      const Eigen::Vector2d p =
          (1 - u) * (1 - v) * a + u * (1 - v) * b + (1 - u) * v * c + u * v * d;
      const auto x = std::lround(p.x());
      const auto y = std::lround(p.y());
      if (x < 0 || y < 0 || x >= image.width_px || y >= image.height_px) continue;
      sum += image.at(static_cast<int>(x), static_cast<int>(y));
      ++count;
    }
  }
  return count == 0 ? 0.0 : sum / count;
}

/// Levels of squares of odd parity minus those of even parity, on average. Positive if the square
/// at the first corner is dark.
double parity_contrast(const Image& image,
                       const std::vector<cv::Point2f>& corners,
                       const Board& board) {
  std::array<double, 2> sums{};
  std::array<int, 2> counts{};
  for (int row = 0; row + 1 < board.rows; ++row) {
    for (int col = 0; col + 1 < board.cols; ++col) {
      const auto parity = static_cast<std::size_t>((row + col) % 2);
      sums[parity] += square_level(image, corners, board, row * board.cols + col);
      ++counts[parity];
    }
  }
  return sums[1] / counts[1] - sums[0] / counts[0];
}

/// Orders rows and columns as a viewer of the printed side sees them: x to y turns clockwise in the
/// image, whose y axis points down.
void unmirror(std::vector<cv::Point2f>& corners, const Board& board) {
  const Eigen::Vector2d x = at(corners, board.cols - 1) - at(corners, 0);
  const Eigen::Vector2d y = at(corners, board.cols * (board.rows - 1)) - at(corners, 0);
  if (x.x() * y.y() - x.y() * y.x() > 0.0) return;
  for (auto row = corners.begin(); row != corners.end(); row += board.cols) {
    std::reverse(row, row + board.cols);
  }
}

/// The shortest distance between neighbours in rows and columns.
double spacing_px(const std::vector<cv::Point2f>& corners, const Board& board) {
  double least = std::numeric_limits<double>::infinity();
  for (int id = 0; id < board.corner_count(); ++id) {
    if (id % board.cols != 0)
      least = std::min(least, (at(corners, id) - at(corners, id - 1)).norm());
    if (id < board.cols) continue;
    least = std::min(least, (at(corners, id) - at(corners, id - board.cols)).norm());
  }
  return least;
}

/// Moves corners to where the image's gradients around them are perpendicular to the direction to
/// them (Forstner, Gulch 1987), in a window that stays clear of the neighbours.
void refine(const cv::Mat& grey, const Board& board, std::vector<cv::Point2f>& corners) {
  const int half_px = std::clamp(static_cast<int>(0.35 * spacing_px(corners, board)), 2, 10);
  const cv::TermCriteria end(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-4);
  cv::cornerSubPix(grey, corners, cv::Size(half_px, half_px), cv::Size(-1, -1), end);
}

bool find_corners(const Image& image, const Board& board, std::vector<cv::Point2f>& corners) {
  const cv::Mat grey(image.height_px,
                     image.width_px,
                     CV_8UC1,
                     const_cast<std::uint8_t*>(image.data.data()));  // only read
  const bool found = cv::findChessboardCornersSB(
      grey, cv::Size(board.cols, board.rows), corners, cv::CALIB_CB_NORMALIZE_IMAGE);
  if (!found || corners.size() != static_cast<std::size_t>(board.corner_count())) return false;
  refine(grey, board, corners);
  return true;
}

Status check_image(const Image& image) {
  const auto good = [](int side) { return side >= kLeastSidePx && side <= kMostSidePx; };
  if (image.channels == 1 && good(image.width_px) && good(image.height_px)) return {};
  return Error{ErrorCode::kInvalidArgument,
               "image of " + std::to_string(image.width_px) + " x " +
                   std::to_string(image.height_px) + " px with " + std::to_string(image.channels) +
                   " channels: must be grey with sides in [16, 16384] px"};
}

}  // namespace

Result<std::optional<BoardView>> detect_board(const Image& image, const Board& board) {
  if (Status status = check_image(image); !status) return status.error();
  std::vector<cv::Point2f> corners;
  try {
    if (board.markers) return detect_charuco(image, board);
    if (!find_corners(image, board, corners)) return std::optional<BoardView>();
  } catch (const cv::Exception& failure) {
    return Error{ErrorCode::kInternal, std::string("OpenCV's board detector: ") + failure.what()};
  }
  unmirror(corners, board);
  if (!board.half_turn_symmetric() && parity_contrast(image, corners, board) < 0.0) {
    std::reverse(corners.begin(), corners.end());
  }
  BoardView view;
  for (int id = 0; id < board.corner_count(); ++id) view.corners.push_back({id, at(corners, id)});
  return std::optional<BoardView>(std::move(view));
}

}  // namespace overfly::calibration
