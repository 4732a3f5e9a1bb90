// Inside terrain only: heights at posts, kept in memory.
#pragma once

#include <cstddef>
#include <vector>

namespace overfly::terrain {

/// Heights [m] at posts; post (0, 0) is the north-west one. NaN = no data.
struct HeightGrid {
  int columns = 0;
  int rows = 0;
  std::vector<float> heights_m;

  [[nodiscard]] float& at(int column, int row) {
    return heights_m[static_cast<std::size_t>(row) * columns + column];
  }
  [[nodiscard]] float at(int column, int row) const {
    return heights_m[static_cast<std::size_t>(row) * columns + column];
  }
  /// Bilinear between the four surrounding posts (post centres at integers); outside, the edge's
  /// value. NaN if a contributing post is NaN.
  [[nodiscard]] double bilinear(double column, double row) const;
};

/// Fills posts without data from those around them, by interpolation between successively coarser
/// averages (push-pull: Gortler et al., The Lumigraph, 1996, sec. 3.4).
/// @return number of posts filled; all posts have data afterwards unless none had
std::size_t fill_voids(HeightGrid& grid);

}  // namespace overfly::terrain
