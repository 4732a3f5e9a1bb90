#include "terrain/elevation/height_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace overfly::terrain {

double HeightGrid::bilinear(double column, double row) const {
  const double u = std::clamp(column, 0.0, columns - 1.0);
  const double v = std::clamp(row, 0.0, rows - 1.0);
  const int i = std::min(static_cast<int>(u), std::max(0, columns - 2));
  const int j = std::min(static_cast<int>(v), std::max(0, rows - 2));
  const double s = u - i;
  const double t = v - j;
  const int east = std::min(i + 1, columns - 1);
  const int south = std::min(j + 1, rows - 1);
  // The NaN of a post with weight 0 must not propagate.
  const auto blend = [](double a, double b, double share) {
    if (share == 0.0) return a;
    return share == 1.0 ? b : a + share * (b - a);
  };
  return blend(blend(at(i, j), at(east, j), s), blend(at(i, south), at(east, south), s), t);
}

namespace {

/// As halve_into; NaN where `fine` has no data.
HeightGrid halved(const HeightGrid& fine) {
  HeightGrid coarse;
  coarse.columns = (fine.columns + 1) / 2;
  coarse.rows = (fine.rows + 1) / 2;
  coarse.heights_m.assign(static_cast<std::size_t>(coarse.columns) * coarse.rows,
                          std::numeric_limits<float>::quiet_NaN());
  halve_into(fine, 0, 0, coarse);
  return coarse;
}

}  // namespace

void halve_into(const HeightGrid& fine, int at_column, int at_row, HeightGrid& coarse) {
  for (int j = 0; j < (fine.rows + 1) / 2; ++j) {
    for (int i = 0; i < (fine.columns + 1) / 2; ++i) {
      double sum = 0.0;
      int count = 0;
      for (int v = 2 * j; v < std::min(2 * j + 2, fine.rows); ++v) {
        for (int u = 2 * i; u < std::min(2 * i + 2, fine.columns); ++u) {
          if (std::isnan(fine.at(u, v))) continue;
          sum += fine.at(u, v);
          ++count;
        }
      }
      if (count > 0) coarse.at(at_column + i, at_row + j) = static_cast<float>(sum / count);
    }
  }
}

std::size_t fill_voids(HeightGrid& grid) {
  const auto voids = static_cast<std::size_t>(std::count_if(
      grid.heights_m.begin(), grid.heights_m.end(), [](float h) { return std::isnan(h); }));
  if (voids == 0 || voids == grid.heights_m.size()) return voids;
  HeightGrid coarse = halved(grid);
  fill_voids(coarse);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      float& height = grid.at(i, j);
      if (std::isnan(height)) {
        height = static_cast<float>(coarse.bilinear(0.5 * i - 0.25, 0.5 * j - 0.25));
      }
    }
  }
  return voids;
}

}  // namespace overfly::terrain
