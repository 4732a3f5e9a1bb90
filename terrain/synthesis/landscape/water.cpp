#include "terrain/synthesis/landscape/water.hpp"

#include <limits>

namespace overfly::terrain::synthesis {

Water Water::plan(float half_m, float airfield_half_x_m, const Parcels& parcels, Dice& dice) {
  Water water;
  water.seed = dice.seed();
  const float room = half_m - airfield_half_x_m;
  water.stream_x_m = -airfield_half_x_m - dice.between(0.40F, 0.55F) * room;
  water.swing_m = 0.22F * room;
  const int wanted = 4 + dice.below(3);
  // Ponds lie inside fields, away from roads and from the stream.
  for (int trial = 0; trial < 4000 && static_cast<int>(water.ponds.size()) < wanted; ++trial) {
    Pond pond;
    pond.radius_m = std::min(dice.between(14.0F, 48.0F), 0.06F * half_m);
    pond.middle = {dice.between(-0.93F, 0.93F) * half_m, dice.between(-0.93F, 0.93F) * half_m};
    pond.seed = dice.seed();
    const ParcelHit hit = parcels.at(pond.middle.x, pond.middle.y);
    const bool free = std::abs(pond.middle.x) > airfield_half_x_m + 2.0F * pond.radius_m &&
                      hit.road_m > 1.5F * pond.radius_m + 15.0F &&
                      hit.border_m > 0.8F * pond.radius_m &&
                      water.stream_m(pond.middle.x, pond.middle.y) > 2.0F * pond.radius_m + 20.0F &&
                      water.pond_m(pond.middle.x, pond.middle.y) > 400.0F;
    if (free) water.ponds.push_back(pond);
  }
  return water;
}

float Water::stream_m(float x, float y) const {
  const auto easting = [&](float at) {
    return stream_x_m + swing_m * noise(0.0023F * at, 1.0F, seed) +
           0.22F * swing_m * noise(0.0095F * at, 2.0F, seed) +
           5.0F * noise(0.045F * at, 4.0F, seed);
  };
  const float offset = x - easting(y);
  const float slope = 0.125F * (easting(y + 4.0F) - easting(y - 4.0F));
  return std::abs(offset) / std::sqrt(1.0F + slope * slope);
}

float Water::pond_m(float x, float y) const {
  float nearest = std::numeric_limits<float>::max();
  for (const Pond& pond : ponds) {
    const float dx = x - pond.middle.x;
    const float dy = y - pond.middle.y;
    const float distance = std::hypot(dx, dy);
    if (distance > 4.0F * pond.radius_m + 100.0F) {
      nearest = std::min(nearest, distance - 1.6F * pond.radius_m);
      continue;
    }
    const float inverse = 1.0F / std::max(distance, 1e-3F);
    const float lobes = 0.32F * noise(1.4F * dx * inverse + 3.0F, 1.4F * dy * inverse, pond.seed) +
                        0.10F * noise(4.0F * dx * inverse, 4.0F * dy * inverse + 7.0F, pond.seed);
    nearest = std::min(nearest, distance - pond.radius_m * (1.0F + lobes));
  }
  return nearest;
}

}  // namespace overfly::terrain::synthesis
