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

/// Halves the resolution of `fine`: each coarse post is the mean of the up to 2 x 2 fine posts with
/// data, and keeps its value if there are none. Writes to `coarse` from (at_column, at_row) on.
/// @pre `coarse` has room for the result
void halve_into(const HeightGrid& fine, int at_column, int at_row, HeightGrid& coarse);

/// Fills posts without data from those around them, by interpolation between successively coarser
/// averages (push-pull: Gortler et al., The Lumigraph, 1996, sec. 3.4).
/// @return number of posts filled; all posts have data afterwards unless none had
std::size_t fill_voids(HeightGrid& grid);

}  // namespace overfly::terrain
