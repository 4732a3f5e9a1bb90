#include "core/text/percent.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace overfly {
namespace {

/// Number of decimals that show a positive number with two significant digits.
int decimals_of(double value) {
  constexpr int kMost = 12;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(value))), 0, kMost);
}

}  // namespace

std::string percent_text(double share) {
  if (share <= 0.0) return "0 %";
  if (share >= 1.0) return "100 %";
  const double percent = 100.0 * share;
  char text[32];
  std::snprintf(
      text, sizeof(text), "%.*f %%", decimals_of(std::min(percent, 100.0 - percent)), percent);
  return text;
}

}  // namespace overfly
