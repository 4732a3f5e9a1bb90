// FAST corners of one cell of an image.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

namespace overfly::odometry::feature {

/// Largest side of a cell [px].
inline constexpr int kFastCellPx = 32;
/// The test of a pixel reads up to this far around it [px].
inline constexpr int kFastReachPx = 3;

struct FastCorner {
  cv::Point pixel;  ///< of the image
  int score = 0;    ///< largest threshold at which it is a corner
};

/// The corners of a cell at the first threshold at which there are any, in reading order. Only
/// pixels whose score exceeds that of their eight neighbours in the cell count. The bits are those
/// of cv::FAST over the cell and what is around it.
///
/// Method: FAST-9 with the score of its third section (Rosten and Drummond 2006,
/// DOI 10.1007/11744023_34).
/// @param image  CV_8U
/// @param cell  at most kFastCellPx wide and high; kFastReachPx around it are inside the image
/// @param thresholds  grey levels, at least one, descending
/// @param out  is replaced
void find_fast_corners(const cv::Mat& image,
                       const cv::Rect& cell,
                       std::span<const int> thresholds,
                       std::vector<FastCorner>& out);
/// By OpenCV, for machines without AVX2.
void find_fast_corners_by_opencv(const cv::Mat& image,
                                 const cv::Rect& cell,
                                 std::span<const int> thresholds,
                                 std::vector<FastCorner>& out);

}  // namespace overfly::odometry::feature
