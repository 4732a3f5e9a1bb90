// A stream and ponds.
#pragma once

#include <vector>

#include "terrain/synthesis/landscape/parcels.hpp"

namespace overfly::terrain::synthesis {

struct Pond {
  Point middle;
  float radius_m = 30.0F;
  std::uint32_t seed = 0;
};

struct Water {
  float stream_x_m = -1000.0F;  ///< mean easting of the stream, which runs north to south
  float swing_m = 150.0F;
  std::uint32_t seed = 0;
  std::vector<Pond> ponds;

  /// @param airfield_half_x_m  kept free of water around the middle
  static Water plan(float half_m, float airfield_half_x_m, const Parcels& parcels, Dice& dice);

  /// Distance to the stream's middle line.
  [[nodiscard]] float stream_m(float x, float y) const;
  /// Half the stream's width here.
  [[nodiscard]] float stream_half_width_m(float y) const {
    return 2.6F + 1.1F * noise(0.02F * y, 3.0F, seed + 9);
  }
  /// Distance to the nearest shore of a pond, negative in the water.
  [[nodiscard]] float pond_m(float x, float y) const;
};

}  // namespace overfly::terrain::synthesis
