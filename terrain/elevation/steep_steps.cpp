#include "terrain/elevation/steep_steps.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::terrain {

double impossible_step_m(double spacing_m) {
  constexpr double kHighestM = 1000.0;
  constexpr double kTangent70Deg = 2.75;
  return std::max(kHighestM, kTangent70Deg * spacing_m);
}

void SteepSteps::compare(float a, float b) {
  const double step_m = std::abs(static_cast<double>(a) - b);
  if (!(step_m > least_m_)) return;  // also if one of them is NaN
  ++count_;
  largest_m_ = std::max(largest_m_, step_m);
}

void SteepSteps::add(int left, const HeightGrid& block) {
  if (left == 0) before_m_.assign(static_cast<std::size_t>(block.rows), kNone);
  float* const above_m = above_m_.data() + left;
  for (int j = 0; j < block.rows; ++j) {
    float before_m = before_m_[static_cast<std::size_t>(j)];
    for (int i = 0; i < block.columns; ++i) {
      const float here_m = block.at(i, j);
      compare(before_m, here_m);
      compare(above_m[i], here_m);
      before_m = here_m;
      above_m[i] = here_m;
    }
    before_m_[static_cast<std::size_t>(j)] = before_m;
  }
}

}  // namespace overfly::terrain
