// The colour of the open ground: fields, roads, yards, water, airfield.
#pragma once

#include <vector>

#include "terrain/synthesis/landscape/landscape.hpp"

namespace overfly::terrain::synthesis {

/// Slowly varying quantities, computed on a coarse lattice and interpolated.
struct Slow {
  float bend_x = 0.0F;  ///< of the boundaries [m]
  float bend_y = 0.0F;
  float soil = 0.0F;      ///< variation of the soil, about [-1, 1], 20 m and more
  float patches = 0.0F;   ///< as soil, 4 m to 30 m
  float light = 1.0F;     ///< on the slope
  float stream_m = 0.0F;  ///< distance to the stream's middle
  float stream_half_m = 3.0F;
  float pond_m = 0.0F;  ///< distance to the shore
  float wood = 0.0F;    ///< share of woodland floor
  float drift = 1.0F;   ///< of brightness over the countryside
};

[[nodiscard]] Slow slow_at(const Landscape& land, float x, float y);
[[nodiscard]] Slow interpolate(const Slow& a, const Slow& b, float t);

/// @param yards  those that may reach the place
[[nodiscard]] Rgb ground_colour(const Landscape& land,
                                const std::vector<const Yard*>& yards,
                                const Slow& slow,
                                float x,
                                float y);

/// Distance to a yard's ragged edge, negative inside.
[[nodiscard]] float yard_m(const Yard& yard, float x, float y);

}  // namespace overfly::terrain::synthesis
