#include "odometry/feature/pyramid.hpp"

#include <algorithm>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace overfly::odometry {

namespace {

constexpr int kFullLevel = 250;     ///< grey level from which a pixel says nothing
constexpr int kFullShare = 192;     ///< of 255: share of such pixels that makes a cell burnt
constexpr int kLeastAreaCells = 3;  ///< side of the smallest area
/// Averages noise to a fifteenth; ground in coarse, blurred pictures still has its corners there.
constexpr int kQuietLevel = 3;
constexpr int kQuietThreshold = 4;  ///< of FAST [grey levels]
/// Least number per pixel of the level. Measured: 0.9e-3 and fewer where 2 % of the light is left,
/// 9e-3 and more over ground that a photograph of 0.8 m per pixel shows blurred from 50 m.
constexpr double kQuietCorners = 1.5e-3;

}  // namespace

cv::Mat find_burnt(const cv::Mat& image) {
  cv::Mat full;
  cv::threshold(image, full, kFullLevel - 1, 255.0, cv::THRESH_BINARY);
  const int least_px = kLeastAreaCells * kBurntCellPx;
  if (cv::countNonZero(full) < least_px * least_px / 2) return {};
  cv::Mat cells;
  const cv::Size size((image.cols + kBurntCellPx - 1) / kBurntCellPx,
                      (image.rows + kBurntCellPx - 1) / kBurntCellPx);
  cv::resize(full, cells, size, 0.0, 0.0, cv::INTER_AREA);
  cv::threshold(cells, cells, kFullShare - 1, 255.0, cv::THRESH_BINARY);
  cv::erode(cells, cells, cv::Mat::ones(kLeastAreaCells, kLeastAreaCells, CV_8U));
  if (cv::countNonZero(cells) == 0) return {};
  // Back to the area's size, and one cell more.
  cv::dilate(cells, cells, cv::Mat::ones(kLeastAreaCells + 2, kLeastAreaCells + 2, CV_8U));
  return cells;
}

Pyramid build_pyramid(std::shared_ptr<const Image> image) {
  Pyramid pyramid;
  // OpenCV has no view of constant data; nothing here writes to it.
  auto* data = const_cast<std::uint8_t*>(image->data.data());
  pyramid.levels.emplace_back(image->height_px, image->width_px, CV_8U, data);
  pyramid.source = std::move(image);
  while (pyramid.level_count() < kPyramidLevels) {
    const cv::Mat& above = pyramid.levels.back();
    if (std::min(above.cols, above.rows) < 64) break;
    cv::Mat half;
    cv::pyrDown(above, half);
    pyramid.levels.push_back(half);
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
