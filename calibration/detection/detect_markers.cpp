#include "calibration/detection/detect_markers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "calibration/detection/grey_level.hpp"
#include "calibration/marker_dictionary.hpp"
#include "calibration/solver/plane_homography.hpp"

namespace overfly::calibration {
namespace {

using Quad = std::array<Eigen::Vector2d, 4>;

constexpr double kLeastMarkerSidePx = 8.0;
constexpr double kLeastContrast = 20.0;  // grey levels

double doubled_area(const Quad& quad) {
  const Eigen::Vector2d a = quad[2] - quad[0];
  const Eigen::Vector2d b = quad[3] - quad[1];
  return a.x() * b.y() - a.y() * b.x();
}

/// The contour as a convex quadrilateral, clockwise in the image.
std::optional<Quad> quad_of(const std::vector<cv::Point>& contour, std::size_t longest) {
  if (contour.size() < 4 * static_cast<std::size_t>(kLeastMarkerSidePx) ||
      contour.size() > longest) {
    return std::nullopt;
  }
  std::vector<cv::Point> polygon;
  cv::approxPolyDP(contour, polygon, 0.03 * static_cast<double>(contour.size()), true);
  if (polygon.size() != 4 || !cv::isContourConvex(polygon)) return std::nullopt;
  Quad quad;
  for (std::size_t i = 0; i < 4; ++i) quad[i] = {polygon[i].x, polygon[i].y};
  for (std::size_t i = 0; i < 4; ++i) {
    if ((quad[i] - quad[(i + 1) % 4]).norm() < kLeastMarkerSidePx) return std::nullopt;
  }
  if (doubled_area(quad) < 0.0) std::swap(quad[1], quad[3]);
  return quad;
}

/// Of several windows, because one must be larger than a marker's border and smaller than shadows.
std::vector<Quad> candidate_quads(const cv::Mat& grey) {
  std::vector<Quad> quads;
  const int side = std::max(grey.cols, grey.rows);
  for (const int part : {60, 24, 8}) {
    cv::Mat dark;
    cv::adaptiveThreshold(grey,
                          dark,
                          255,
                          cv::ADAPTIVE_THRESH_MEAN_C,
                          cv::THRESH_BINARY_INV,
                          std::max(7, side / part) | 1,
                          7);
    std::vector<std::vector<cv::Point>> contours;
    cv::findContours(dark, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    for (const std::vector<cv::Point>& contour : contours) {
      const auto quad = quad_of(contour, 4 * static_cast<std::size_t>(side));
      if (quad) quads.push_back(*quad);
    }
  }
  return quads;
}

/// Mean levels of the cells, border included, row by row.
std::optional<std::vector<double>> cell_levels(const Image& image, const Quad& quad, int cells) {
  const double n = cells;
  const auto H =
      homography({{{0, 0}, quad[0]}, {{n, 0}, quad[1]}, {{n, n}, quad[2]}, {{0, n}, quad[3]}});
  if (!H) return std::nullopt;
  std::vector<double> levels;
  for (int row = 0; row < cells; ++row) {
    for (int col = 0; col < cells; ++col) {
      double sum = 0.0;
      for (const double v : {0.3, 0.5, 0.7}) {
        for (const double u : {0.3, 0.5, 0.7}) {
          const Eigen::Vector2d pixel =
              Eigen::Vector3d(*H * Eigen::Vector3d(col + u, row + v, 1.0)).hnormalized();
          const auto level = grey_level(image, pixel);
          if (!level) return std::nullopt;
          sum += *level;
        }
      }
      levels.push_back(sum / 9.0);
    }
  }
  return levels;
}

std::optional<FoundMarker> read_marker(const Image& image, const Quad& quad, int bits) {
  const int cells = bits + 2;
  const auto levels = cell_levels(image, quad, cells);
  if (!levels) return std::nullopt;
  const auto [darkest, brightest] = std::minmax_element(levels->begin(), levels->end());
  if (*brightest - *darkest < kLeastContrast) return std::nullopt;
  const double middle = 0.5 * (*darkest + *brightest);
  std::uint64_t read = 0;
  for (int row = 0; row < cells; ++row) {
    for (int col = 0; col < cells; ++col) {
      const bool bright = (*levels)[static_cast<std::size_t>(row * cells + col)] > middle;
      const bool border = row == 0 || col == 0 || row == cells - 1 || col == cells - 1;
      if (border && bright) return std::nullopt;
      if (!border) read = read << 1U | (bright ? 1U : 0U);
    }
  }
  const auto match = find_marker(bits, read);
  if (!match) return std::nullopt;
  FoundMarker marker{match->id, {}};
  for (std::size_t i = 0; i < 4; ++i) {
    marker.corners[i] = quad[(i + static_cast<std::size_t>(match->turns)) % 4];
  }
  return marker;
}

}  // namespace

std::vector<FoundMarker> detect_markers(const Image& image, int bits) {
  const cv::Mat grey(image.height_px,
                     image.width_px,
                     CV_8UC1,
                     const_cast<std::uint8_t*>(image.data.data()));  // only read
  std::map<int, FoundMarker> found;
  for (const Quad& quad : candidate_quads(grey)) {
    const auto marker = read_marker(image, quad, bits);
    if (!marker) continue;
    const auto known = found.find(marker->id);
    // The outermost of several contours of a marker.
    if (known != found.end() && doubled_area(known->second.corners) >= doubled_area(quad)) continue;
    found[marker->id] = *marker;
  }
  std::vector<FoundMarker> markers;
  for (const auto& [id, marker] : found) markers.push_back(marker);
  return markers;
}

}  // namespace overfly::calibration
