#include "calibration/detection/detect_charuco.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

#include "calibration/detection/detect_markers.hpp"
#include "calibration/detection/grey_level.hpp"
#include "calibration/solver/plane_homography.hpp"

namespace overfly::calibration {
namespace {

/// A marker in its square; places on the board are in squares.
struct PlacedMarker {
  Eigen::Vector2d square;  ///< its corner with the smallest coordinates
  std::array<Eigen::Vector2d, 4> board;
  std::array<Eigen::Vector2d, 4> image;
};

struct Prediction {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  double reach_px = std::numeric_limits<double>::infinity();  ///< to the nearest marker
};

std::vector<PlacedMarker> placed_markers(const Board& board,
                                         const std::vector<FoundMarker>& found) {
  std::vector<PlacedMarker> placed;
  const double gap = board.marker_gap();
  for (const FoundMarker& marker : found) {
    if (marker.id >= board.marker_count()) continue;
    const Eigen::Vector2d at = board.marker_square(marker.id).cast<double>();
    const double far = 1.0 - gap;
    placed.push_back({at,
                      {at + Eigen::Vector2d(gap, gap),
                       at + Eigen::Vector2d(far, gap),
                       at + Eigen::Vector2d(far, far),
                       at + Eigen::Vector2d(gap, far)},
                      marker.corners});
  }
  return placed;
}

/// Removes markers that are not where the others put them: patterns of the scene that happen to be
/// in the dictionary. The limit is a marker's side, which distortion does not exceed.
std::vector<PlacedMarker> consistent(const std::vector<PlacedMarker>& markers) {
  constexpr std::size_t kLeastMarkers = 4;
  if (markers.size() < kLeastMarkers) return {};
  std::vector<cv::Point2d> board;
  std::vector<cv::Point2d> image;
  std::vector<double> sides;
  for (const PlacedMarker& marker : markers) {
    const Eigen::Vector2d b = 0.5 * (marker.board[0] + marker.board[2]);
    const Eigen::Vector2d p =
        0.25 * (marker.image[0] + marker.image[1] + marker.image[2] + marker.image[3]);
    board.emplace_back(b.x(), b.y());
    image.emplace_back(p.x(), p.y());
    sides.push_back((marker.image[1] - marker.image[0]).norm());
  }
  std::nth_element(
      sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2), sides.end());
  cv::Mat inliers;
  const cv::Mat H = cv::findHomography(board, image, cv::RANSAC, sides[sides.size() / 2], inliers);
  if (H.empty()) return {};
  std::vector<PlacedMarker> kept;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (inliers.at<std::uint8_t>(static_cast<int>(i)) != 0) kept.push_back(markers[i]);
  }
  return kept.size() < kLeastMarkers ? std::vector<PlacedMarker>() : kept;
}

/// Where the markers put the corners of their squares, by id.
std::map<int, Prediction> predictions(const Board& board,
                                      const std::vector<PlacedMarker>& markers) {
  std::map<int, Prediction> predicted;
  for (const PlacedMarker& marker : markers) {
    std::vector<PlanePair> pairs;
    for (std::size_t i = 0; i < 4; ++i) pairs.push_back({marker.board[i], marker.image[i]});
    const auto H = homography(pairs);
    if (!H) continue;
    for (const int right : {0, 1}) {
      for (const int down : {0, 1}) {
        const Eigen::Vector2d at = marker.square + Eigen::Vector2d(right, down);
        if (at.minCoeff() < 0.0 || at.x() >= board.cols || at.y() >= board.rows) continue;
        const Eigen::Vector2d pixel = Eigen::Vector3d(*H * at.homogeneous()).hnormalized();
        Prediction& corner =
            predicted[static_cast<int>(at.y()) * board.cols + static_cast<int>(at.x())];
        corner.sum += pixel;
        ++corner.count;
        for (const Eigen::Vector2d& other : marker.image) {
          corner.reach_px = std::min(corner.reach_px, (other - pixel).norm());
        }
      }
    }
  }
  return predicted;
}

/// The gradients' corner near a prediction, in a window that stays clear of the markers.
std::optional<Eigen::Vector2d> refined(const cv::Mat& grey, const Prediction& prediction) {
  // Closer markers fall into the smallest window, and draw the corner away by tenths of a pixel.
  constexpr double kLeastReachPx = 4.0;
  const Eigen::Vector2d first = prediction.sum / prediction.count;
  // A distorted marker may put its corners at infinity.
  if (!first.allFinite() || prediction.reach_px < kLeastReachPx) return std::nullopt;
  const int half_px = std::clamp(static_cast<int>(0.7 * prediction.reach_px), 2, 10);
  const double edge = half_px + 1.0;
  if (first.minCoeff() < edge || first.x() > grey.cols - 1 - edge ||
      first.y() > grey.rows - 1 - edge) {
    return std::nullopt;
  }
  std::vector<cv::Point2f> corner = {
      {static_cast<float>(first.x()), static_cast<float>(first.y())}};
  const cv::TermCriteria end(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-4);
  cv::cornerSubPix(grey, corner, cv::Size(half_px, half_px), cv::Size(-1, -1), end);
  const Eigen::Vector2d at(corner[0].x, corner[0].y);
  if ((at - first).norm() > half_px) return std::nullopt;
  return at;
}

/// True if the squares around a corner have the board's colours close to it, so that nothing covers
/// it.
bool shows_corner(const Image& image,
                  const Board& board,
                  int id,
                  const Eigen::Vector2d& corner,
                  const Eigen::Matrix3d& H) {
  constexpr double kLeastDifference = 10.0;  // grey levels
  const Eigen::Vector2d at(id % board.cols, id / board.cols);
  const Eigen::Vector2d origin = Eigen::Vector3d(H * at.homogeneous()).hnormalized();
  const double step = 0.5 * board.marker_gap();
  double darkest_bright = 255.0;
  double brightest_dark = 0.0;
  for (const double right : {-step, step}) {
    for (const double down : {-step, step}) {
      const Eigen::Vector2d place = at + Eigen::Vector2d(right, down);
      const Eigen::Vector2d pixel =
          corner + Eigen::Vector3d(H * place.homogeneous()).hnormalized() - origin;
      const auto level = grey_level(image, pixel);
      if (!level) return false;
      const auto parity = std::lround(std::floor(place.x()) + std::floor(place.y()));
      if (parity % 2 == 0) {
        brightest_dark = std::max(brightest_dark, *level);
      } else {
        darkest_bright = std::min(darkest_bright, *level);
      }
    }
  }
  return darkest_bright - brightest_dark > kLeastDifference;
}

bool spread_enough(const Board& board, const BoardView& view) {
  std::set<int> cols;
  std::set<int> rows;
  for (const BoardCorner& corner : view.corners) {
    cols.insert(corner.id % board.cols);
    rows.insert(corner.id / board.cols);
  }
  return static_cast<int>(view.corners.size()) >= kLeastCharucoCorners && cols.size() >= 3 &&
         rows.size() >= 3;
}

}  // namespace

std::optional<BoardView> detect_charuco(const Image& image, const Board& board) {
  const cv::Mat grey(image.height_px,
                     image.width_px,
                     CV_8UC1,
                     const_cast<std::uint8_t*>(image.data.data()));  // only read
  const std::vector<PlacedMarker> markers =
      consistent(placed_markers(board, detect_markers(image, board.markers->bits)));
  std::vector<PlanePair> pairs;
  for (const PlacedMarker& marker : markers) {
    for (std::size_t i = 0; i < 4; ++i) pairs.push_back({marker.board[i], marker.image[i]});
  }
  const auto H = homography(pairs);
  if (!H) return std::nullopt;
  BoardView view;
  for (const auto& [id, prediction] : predictions(board, markers)) {
    const auto corner = refined(grey, prediction);
    if (corner && shows_corner(image, board, id, *corner, *H))
      view.corners.push_back({id, *corner});
  }
  if (!spread_enough(board, view)) return std::nullopt;
  return view;
}

}  // namespace overfly::calibration
