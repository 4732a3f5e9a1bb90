#include "server/experiments/explain/data_limit.hpp"

#include <cstdio>

namespace overfly::server::experiments {
namespace {

/// Ground without imagery that may make an estimator fail, as a share of the image.
constexpr double kMuchVoid = 0.3;

std::string with_number(const char* format, double number) {
  char text[160];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

}  // namespace

std::string data_limit(const Reflight& control,
                       const std::vector<Cause>& necessary,
                       const std::vector<Cause>& sufficient) {
  const double texels = control.texels_per_pixel_median;
  if (holds(necessary, Cause::kTexture)) {
    return with_number(
        "The imagery has %.2f texels per pixel; with synthetic detail the estimator survives.",
        texels);
  }
  if (!necessary.empty() || !sufficient.empty()) return "";
  if (control.texture_limited) {
    return with_number("The imagery has %.2f texels per pixel, less than 0.5.", texels);
  }
  if (control.void_fraction_max > kMuchVoid) {
    return with_number("Up to %.0f %% of an image shows no imagery.",
                       100.0 * control.void_fraction_max);
  }
  return "";
}

}  // namespace overfly::server::experiments
