#include "server/experiments/predict/features/features.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::server::predict {
namespace {

/// Correlations near 1 differ in how far they are from it.
constexpr double kMostSimilar = 1.02;

}  // namespace

Inputs inputs_of(const Features& features) {
  const double texels = std::clamp(features.texels_per_pixel, 1.0 / 32.0, 2.0);
  const double corners = features.corners_per_kpx * features.image_kpx;
  const auto per_width = [&](double motion_px) {
    return std::min(0.5, motion_px / features.image_width_px);
  };
  const double low_sun =
      features.sun_elevation_deg
          ? 1.0 - std::sin(rad_from_deg(std::clamp(*features.sun_elevation_deg, 0.0, 90.0)))
          : 0.0;
  return {std::log2(texels),
          std::log1p(corners),
          features.bare_share,
          -std::log(kMostSimilar - std::clamp(features.self_similarity, 0.0, 1.0)),
          std::clamp(features.relief, 0.0, 1.0),
          per_width(features.rotation_px),
          per_width(features.translation_px),
          (1.0 - features.overlap) * (1.0 - features.overlap),
          std::log1p(features.blur_px),
          std::log1p(features.noise_grey),
          features.void_share,
          low_sun};
}

}  // namespace overfly::server::predict
