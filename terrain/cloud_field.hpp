// Inside terrain only: where clouds take the sun's light.
#pragma once

#include "terrain/light.hpp"

namespace overfly::terrain {

/// Fractal noise (octaves of half the size and half the strength) over a threshold that is set so
/// that the mean over the ground is the cover that was asked.
class CloudField {
 public:
  explicit CloudField(const CloudOptions& options);

  /// Share of the direct light that is left at a place of the map, in [1 - strength, 1].
  [[nodiscard]] double transmission(double x_map_m, double y_map_m) const;

 private:
  [[nodiscard]] float thickness(double x_map_m, double y_map_m) const;

  CloudOptions options_;
  std::uint32_t seed_;
  float threshold_ = 0.0F;
};

}  // namespace overfly::terrain
