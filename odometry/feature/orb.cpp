#include "odometry/feature/orb.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "odometry/feature/fast_corners.hpp"

namespace overfly::odometry::feature {
namespace {

/// FAST threshold of the last attempt on ground of low texture. Noise also exceeds it; whether
/// there is enough texture is decided when a patch is made.
constexpr int kFaintest = 2;
constexpr int kMarginPx = 20;  ///< room for the rotated pattern
constexpr int kPatternRadius = 15;

struct PatternPair {
  float ax, ay, bx, by;
};

/// One coordinate of Calonder's G II: normal with sigma = S / 5 for a patch of side S. Does not use
/// the distributions of <random>, whose results differ between standard libraries.
float pattern_coordinate(std::mt19937& generator) {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += static_cast<double>(generator()) / 4294967296.0;
  const double sigma = (2.0 * kPatternRadius + 1.0) / 5.0;
  const double value = std::clamp((sum - 6.0) * sigma, -10.0, 10.0);
  return static_cast<float>(value);
}

const std::array<PatternPair, 256>& pattern() {
  static const std::array<PatternPair, 256> pairs = [] {
    std::mt19937 generator(20100905U);
    std::array<PatternPair, 256> made{};
    for (PatternPair& pair : made) {
      pair.ax = pattern_coordinate(generator);
      pair.ay = pattern_coordinate(generator);
      pair.bx = pattern_coordinate(generator);
      pair.by = pattern_coordinate(generator);
    }
    return made;
  }();
  return pairs;
}

/// Direction from the corner to the centroid of brightness in a disc (Rosin's moments), as a unit
/// vector.
Eigen::Vector2f centroid_direction(const cv::Mat& image, const Eigen::Vector2i& p) {
  int m10 = 0;
  int m01 = 0;
  for (int dy = -kPatternRadius; dy <= kPatternRadius; ++dy) {
    const int half =
        static_cast<int>(std::sqrt(static_cast<double>(kPatternRadius * kPatternRadius - dy * dy)));
    const std::uint8_t* row = image.ptr<std::uint8_t>(p.y() + dy) + p.x();
    int row_sum = 0;
    for (int dx = -half; dx <= half; ++dx) {
      m10 += dx * row[dx];
      row_sum += row[dx];
    }
    m01 += dy * row_sum;
  }
  const Eigen::Vector2f moment(static_cast<float>(m10), static_cast<float>(m01));
  const float length = moment.norm();
  return length > 0.0F ? Eigen::Vector2f(moment / length) : Eigen::Vector2f(1.0F, 0.0F);
}

/// Selects corners in rounds: the best of every cell, then the second best of every cell, ...
std::vector<Corner> take_in_rounds(std::vector<std::vector<Corner>> cells, int wanted) {
  std::vector<Corner> taken;
  for (auto& cell : cells) {
    std::stable_sort(cell.begin(), cell.end(), [](const Corner& a, const Corner& b) {
      return a.response > b.response;
    });
  }
  for (std::size_t round = 0; static_cast<int>(taken.size()) < wanted; ++round) {
    std::vector<Corner> found;
    for (const auto& cell : cells) {
      if (round < cell.size()) found.push_back(cell[round]);
    }
    if (found.empty()) break;
    std::stable_sort(found.begin(), found.end(), [](const Corner& a, const Corner& b) {
      return a.response > b.response;
    });
    const std::size_t room = static_cast<std::size_t>(wanted) - taken.size();
    taken.insert(taken.end(), found.begin(), found.begin() + std::min(room, found.size()));
  }
  return taken;
}

cv::Size level_size(const cv::Size& full, double scale) {
  return {static_cast<int>(std::lround(full.width / scale)),
          static_cast<int>(std::lround(full.height / scale))};
}

/// Thresholds of FAST, of which the first that finds corners in a cell counts.
std::vector<int> fast_thresholds(const FeatureParameters& parameters) {
  std::vector<int> thresholds{parameters.ini_fast_threshold, parameters.min_fast_threshold};
  if (parameters.low_texture) {
    thresholds.push_back(std::min(kFaintest, parameters.min_fast_threshold));
  }
  return thresholds;
}

/// Whether a level is too small for a corner with the margin on both sides.
bool too_small(const cv::Size& level) {
  return std::min(level.width, level.height) < 4 * kMarginPx;
}

}  // namespace

CellGrid CellGrid::over(int width_px, int height_px, int cells) {
  CellGrid grid;
  grid.cell_px = std::sqrt(static_cast<double>(width_px) * height_px / cells);
  grid.columns = static_cast<int>(width_px / grid.cell_px) + 1;
  const int rows = static_cast<int>(height_px / grid.cell_px) + 1;
  grid.marked.assign(static_cast<std::size_t>(grid.columns) * rows, 0);
  return grid;
}

std::size_t CellGrid::index(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d cell = pixel.cwiseMax(0.0) / cell_px;
  return static_cast<std::size_t>(cell.y()) * static_cast<std::size_t>(columns) +
         static_cast<std::size_t>(cell.x());
}

bool CellGrid::any_marked(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const {
  const int rows = static_cast<int>(marked.size()) / columns;
  const int first_column = std::max(0, static_cast<int>(low.x() / cell_px));
  const int first_row = std::max(0, static_cast<int>(low.y() / cell_px));
  const int last_column = std::min(columns - 1, static_cast<int>(high.x() / cell_px));
  const int last_row = std::min(rows - 1, static_cast<int>(high.y() / cell_px));
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      if (marked[static_cast<std::size_t>(row) * columns + column] != 0) return true;
    }
  }
  return false;
}

OrbExtractor::OrbExtractor(const FeatureParameters& parameters) : parameters_(parameters) {
  // A level's share is proportional to its side, so that the density of corners per pixel rises
  // slowly.
  double total = 0.0;
  for (int level = 0; level < parameters.levels; ++level) {
    scales_.push_back(std::pow(parameters.scale_factor, level));
    total += 1.0 / scales_.back();
  }
  for (const double scale : scales_) {
    shares_.push_back(static_cast<int>(std::lround(parameters.features / (scale * total))));
  }
}

void OrbExtractor::look_only_at(const cv::Mat& seen) {
  masks_.clear();
  if (seen.empty() || cv::countNonZero(seen) == seen.cols * seen.rows) return;
  const cv::Mat kernel = cv::Mat::ones(2 * kMarginPx + 1, 2 * kMarginPx + 1, CV_8U);
  for (const double scale : scales_) {
    const cv::Size size = level_size(seen.size(), scale);
    if (too_small(size)) break;
    cv::Mat& mask = masks_.emplace_back();
    cv::resize(seen, mask, size, 0.0, 0.0, cv::INTER_NEAREST);
    cv::erode(mask, mask, kernel);
  }
}

void OrbExtractor::load(const cv::Mat& image) {
  levels_.assign(1, image);
  smoothed_.assign(scales_.size(), cv::Mat());
  for (std::size_t l = 1; l < scales_.size(); ++l) {
    const cv::Size size = level_size(image.size(), scales_[l]);
    if (too_small(size)) break;
    cv::Mat smaller;
    cv::resize(levels_.back(), smaller, size, 0.0, 0.0, cv::INTER_LINEAR);
    levels_.push_back(smaller);
  }
}

std::vector<Corner> OrbExtractor::detect_level(int level, const CellGrid* wanted) const {
  const cv::Mat& image = levels_[static_cast<std::size_t>(level)];
  const cv::Mat mask = masks_.empty() ? cv::Mat() : masks_[static_cast<std::size_t>(level)];
  // Use the rounded sizes, not the nominal scale.
  const Eigen::Array2d scale(static_cast<double>(levels_[0].cols) / image.cols,
                             static_cast<double>(levels_[0].rows) / image.rows);
  std::vector<std::vector<Corner>> cells;
  const std::vector<int> thresholds = fast_thresholds(parameters_);
  std::vector<FastCorner> found;
  for (int y = kMarginPx; y < image.rows - kMarginPx; y += kFastCellPx) {
    for (int x = kMarginPx; x < image.cols - kMarginPx; x += kFastCellPx) {
      const int width = std::min(kFastCellPx, image.cols - kMarginPx - x);
      const int height = std::min(kFastCellPx, image.rows - kMarginPx - y);
      if (wanted != nullptr && !wanted->any_marked(scale * Eigen::Array2d(x, y),
                                                   scale * Eigen::Array2d(x + width, y + height))) {
        continue;
      }
      find_fast_corners(image, {x, y, width, height}, thresholds, found);
      std::vector<Corner>& corners = cells.emplace_back();
      for (const FastCorner& fast : found) {
        if (!mask.empty() && mask.at<std::uint8_t>(fast.pixel) == 0) continue;
        Corner& corner = corners.emplace_back();
        corner.level_pixel = {fast.pixel.x, fast.pixel.y};
        corner.pixel = (corner.level_pixel.cast<double>().array() + 0.5) * scale - 0.5;
        corner.scale_level = level;
        corner.response = static_cast<float>(fast.score);
      }
    }
  }
  return take_in_rounds(std::move(cells), shares_[static_cast<std::size_t>(level)]);
}

std::vector<Corner> OrbExtractor::detect(const cv::Mat& image, const CellGrid* wanted) {
  load(image);
  std::vector<Corner> corners;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const std::vector<Corner> found = detect_level(static_cast<int>(l), wanted);
    corners.insert(corners.end(), found.begin(), found.end());
  }
  return corners;
}

Descriptor OrbExtractor::describe(const Corner& corner) {
  const auto level = static_cast<std::size_t>(corner.scale_level);
  if (smoothed_[level].empty()) {
    cv::GaussianBlur(levels_[level], smoothed_[level], cv::Size(7, 7), 2.0);
  }
  const Eigen::Vector2f direction = centroid_direction(levels_[level], corner.level_pixel);
  const cv::Mat& image = smoothed_[level];
  const auto brightness = [&](float x, float y) {
    const int u = static_cast<int>(std::lround(direction.x() * x - direction.y() * y));
    const int v = static_cast<int>(std::lround(direction.y() * x + direction.x() * y));
    return image.at<std::uint8_t>(corner.level_pixel.y() + v, corner.level_pixel.x() + u);
  };
  Descriptor descriptor{};
  for (std::size_t i = 0; i < 256; ++i) {
    const PatternPair& pair = pattern()[i];
    if (brightness(pair.ax, pair.ay) < brightness(pair.bx, pair.by)) {
      descriptor[i / 64] |= std::uint64_t{1} << (i % 64);
    }
  }
  return descriptor;
}

}  // namespace overfly::odometry::feature
