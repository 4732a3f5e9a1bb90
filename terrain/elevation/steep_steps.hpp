// Inside terrain only: implausibly steep steps between neighbouring posts.
#pragma once

#include <limits>
#include <vector>

#include "terrain/elevation/height_grid.hpp"

namespace overfly::terrain {

/// Smallest height difference between neighbouring posts that does not occur on real ground [m]:
/// steeper than 70 deg and more than 1000 m (the highest cliffs, 1250 m, extend over several
/// posts).
[[nodiscard]] double impossible_step_m(double spacing_m);

/// Counts such steps in posts given block by block, row of blocks by row.
class SteepSteps {
 public:
  explicit SteepSteps(int columns, double least_m)
      : least_m_(least_m), above_m_(static_cast<std::size_t>(columns), kNone) {}

  /// A block whose first post is in column `left` of the raster; NaN where there is no data.
  void add(int left, const HeightGrid& block);

  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] double largest_m() const { return largest_m_; }

 private:
  static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  void compare(float a, float b);

  double least_m_;
  double count_ = 0.0;
  double largest_m_ = 0.0;
  std::vector<float> above_m_;   ///< last row of the preceding row of blocks
  std::vector<float> before_m_;  ///< last column of the preceding block
};

}  // namespace overfly::terrain
