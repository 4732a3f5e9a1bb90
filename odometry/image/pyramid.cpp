#include "odometry/image/pyramid.hpp"

#include <algorithm>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "odometry/image/half_image.hpp"

namespace overfly::odometry {

namespace {

constexpr int kFullShare = 192;     ///< of 255: share of such pixels in a saturated cell
constexpr int kLeastAreaCells = 3;  ///< side of the smallest area
/// At this level noise is reduced to a fifteenth, while the ground in coarse, blurred pictures
/// keeps its corners.
constexpr int kQuietLevel = 3;
constexpr int kQuietThreshold = 4;  ///< of FAST [grey levels]
/// Minimum number of corners per pixel of the level. Measured: 0.9e-3 and less at 2 % of the light,
/// 9e-3 and more from 50 m over ground shown blurred by a photograph of 0.8 m per pixel.
constexpr double kQuietCorners = 1.5e-3;

/// @param saturated_px  number of saturated pixels of the image
cv::Mat find_burnt(const cv::Mat& image, int saturated_px) {
  const int least_px = kLeastAreaCells * kBurntCellPx;
  if (saturated_px < least_px * least_px / 2) return {};
  cv::Mat full;
  cv::threshold(image, full, kSaturatedLevel - 1, 255.0, cv::THRESH_BINARY);
  cv::Mat cells;
  const cv::Size size((image.cols + kBurntCellPx - 1) / kBurntCellPx,
                      (image.rows + kBurntCellPx - 1) / kBurntCellPx);
  cv::resize(full, cells, size, 0.0, 0.0, cv::INTER_AREA);
  cv::threshold(cells, cells, kFullShare - 1, 255.0, cv::THRESH_BINARY);
  cv::erode(cells, cells, cv::Mat::ones(kLeastAreaCells, kLeastAreaCells, CV_8U));
  if (cv::countNonZero(cells) == 0) return {};
  // Restore the area's size and add one cell.
  cv::dilate(cells, cells, cv::Mat::ones(kLeastAreaCells + 2, kLeastAreaCells + 2, CV_8U));
  return cells;
}

}  // namespace

Pyramid build_pyramid(std::shared_ptr<const Image> image, bool mark_burnt) {
  Pyramid pyramid;
  // cv::Mat cannot refer to constant data; nothing here writes to it.
  auto* data = const_cast<std::uint8_t*>(image->data.data());
  pyramid.levels.emplace_back(image->height_px, image->width_px, CV_8U, data);
  pyramid.source = std::move(image);
  std::optional<int> saturated_px;
  while (pyramid.level_count() < kPyramidLevels) {
    const cv::Mat& above = pyramid.levels.back();
    if (std::min(above.cols, above.rows) < 64) break;
    HalfImage half = halved(above);
    if (!saturated_px) saturated_px = half.saturated_px;
    pyramid.levels.push_back(std::move(half.image));
  }
  if (mark_burnt) {
    const cv::Mat& full = pyramid.level(0);
    pyramid.burnt = find_burnt(full, saturated_px ? *saturated_px : count_saturated(full));
  }
  return pyramid;
}

bool shows_something(const Pyramid& pyramid) {
  const cv::Mat& quiet = pyramid.level(std::min(kQuietLevel, pyramid.level_count() - 1));
  std::vector<cv::KeyPoint> corners;
  cv::FAST(quiet, corners, kQuietThreshold);
  return static_cast<double>(corners.size()) > kQuietCorners * static_cast<double>(quiet.total());
}

}  // namespace overfly::odometry
