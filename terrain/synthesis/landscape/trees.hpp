// Single trees: where they stand and how their crowns look from above.
#pragma once

#include <vector>

#include "terrain/synthesis/landscape/landscape.hpp"

namespace overfly::terrain::synthesis {

struct Tree {
  Point at;
  float radius_m = 3.0F;
  float height_m = 8.0F;
  Rgb colour;
  std::uint32_t seed = 0;
};

/// The trees whose crown or shadow may touch a rectangle, in a fixed order, low ones first.
[[nodiscard]] std::vector<Tree> trees_near(
    const Landscape& land, float x_min, float y_min, float x_max, float y_max);

}  // namespace overfly::terrain::synthesis
