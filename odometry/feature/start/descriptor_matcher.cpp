#include "odometry/feature/start/descriptor_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace overfly::odometry::feature {
namespace {

/// Corners sorted into square cells of the image, for neighbourhood searches.
class Buckets {
 public:
  Buckets(const std::vector<Corner>& corners, double cell_px) : cell_px_(cell_px) {
    for (const Corner& corner : corners) {
      columns_ = std::max(columns_, cell_of(corner.pixel.x()) + 1);
      rows_ = std::max(rows_, cell_of(corner.pixel.y()) + 1);
    }
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      at(cell_of(corners[i].pixel.x()), cell_of(corners[i].pixel.y())).push_back(i);
    }
  }
  template <typename Visit>
  void around(const Eigen::Vector2d& pixel, double radius_px, const Visit& visit) {
    const int left = std::max(0, cell_of(pixel.x() - radius_px));
    const int right = std::min(columns_ - 1, cell_of(pixel.x() + radius_px));
    const int top = std::max(0, cell_of(pixel.y() - radius_px));
    const int bottom = std::min(rows_ - 1, cell_of(pixel.y() + radius_px));
    for (int row = top; row <= bottom; ++row) {
      for (int column = left; column <= right; ++column) {
        for (const std::size_t i : at(column, row)) visit(i);
      }
    }
  }

 private:
  [[nodiscard]] int cell_of(double place_px) const {
    return static_cast<int>(std::floor(place_px / cell_px_));
  }
  std::vector<std::size_t>& at(int column, int row) {
    return cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)];
  }

  double cell_px_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace

DescribedCorners describe_image(const cv::Mat& image, OrbExtractor& orb) {
  DescribedCorners described;
  described.corners = orb.detect(image);
  described.descriptors.reserve(described.corners.size());
  for (const Corner& corner : described.corners) {
    described.descriptors.push_back(orb.describe(corner));
  }
  return described;
}

std::vector<std::optional<std::size_t>> match_corners(const DescribedCorners& from,
                                                      const DescribedCorners& to,
                                                      const std::vector<Eigen::Vector2d>& expected,
                                                      const MatcherOptions& options) {
  std::vector<std::optional<std::size_t>> matches(from.corners.size());
  struct Taken {
    std::size_t by = 0;
    int distance = 257;
  };
  std::vector<Taken> taken(to.corners.size());
  Buckets buckets(to.corners, 0.5 * options.radius_px);
  const double radius2 = options.radius_px * options.radius_px;
  for (std::size_t i = 0; i < from.corners.size(); ++i) {
    int best = 257;
    int second = 257;
    std::size_t found = 0;
    buckets.around(expected[i], options.radius_px, [&](std::size_t j) {
      const Corner& corner = to.corners[j];
      if ((corner.pixel - expected[i]).squaredNorm() > radius2 ||
          std::abs(corner.scale_level - from.corners[i].scale_level) > options.max_scale_change) {
        return;
      }
      const int distance = hamming_distance(from.descriptors[i], to.descriptors[j]);
      if (distance < best) {
        // The same corner at the next scale does not count as second best.
        const bool rival = best < 257 && (to.corners[found].pixel - corner.pixel).norm() > 4.0;
        if (rival) second = best;
        best = distance;
        found = j;
      } else if (distance < second && (to.corners[found].pixel - corner.pixel).norm() > 4.0) {
        second = distance;
      }
    });
    if (best > options.max_distance || best > options.ratio * second) continue;
    if (best >= taken[found].distance) continue;
    if (taken[found].distance < 257) matches[taken[found].by].reset();
    taken[found] = {i, best};
    matches[i] = found;
  }
  return matches;
}

}  // namespace overfly::odometry::feature
