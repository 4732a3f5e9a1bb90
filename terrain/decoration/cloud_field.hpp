// Inside terrain only: the attenuation of sunlight by clouds.
#pragma once

#include "terrain/decoration/light.hpp"

namespace overfly::terrain {

/// Fractal noise (each octave has half the size and half the strength) above a threshold, which is
/// chosen so that the mean over the ground equals the requested cover.
class CloudField {
 public:
  explicit CloudField(const CloudOptions& options);

  /// Fraction of the direct light that remains at a place of the map, in [1 - strength, 1].
  [[nodiscard]] double transmission(double x_map_m, double y_map_m) const;

 private:
  [[nodiscard]] float thickness(double x_map_m, double y_map_m) const;

  CloudOptions options_;
  std::uint32_t seed_;
  float threshold_ = 0.0F;
};

}  // namespace overfly::terrain
