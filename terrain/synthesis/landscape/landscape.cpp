#include "terrain/synthesis/landscape/landscape.hpp"

namespace overfly::terrain::synthesis {

Landscape Landscape::plan(const LandscapeOptions& options) {
  Landscape land;
  land.options = options;
  Dice dice(hash(static_cast<int>(options.seed), 1, 0x0f1eU));
  land.airfield = Airfield::plan(options.half_m, dice);
  const float half_x = 275.0F;
  const float half_y = land.airfield.half_length_m() + 110.0F;
  land.parcels = Parcels::plan(options.half_m, half_x, half_y, dice);
  land.water = Water::plan(options.half_m, half_x, land.parcels, dice);
  land.relief = Relief::plan(
      options.half_m, options.reach_m, options.relief_m, land.airfield, land.water, dice.seed());
  land.structures = Structures::plan(options.half_m, land.airfield, land.parcels, land.water, dice);
  return land;
}

Point Landscape::bend_at(float x, float y) const {
  const std::uint32_t seed = water.seed + 50;
  return {9.0F * noise(x / 260.0F, y / 260.0F, seed) + 1.6F * noise(x / 47.0F, y / 47.0F, seed + 1),
          9.0F * noise(x / 260.0F, y / 260.0F, seed + 2) +
              1.6F * noise(x / 47.0F, y / 47.0F, seed + 3)};
}

float Landscape::wood_at(float x, float y) const {
  const std::uint32_t seed = water.seed + 70;
  const Point uv = airfield.to_uv(x, y);
  const float clear = smoothstep(40.0F, 260.0F, airfield.outside_m(uv.x, uv.y));
  const float growth = fractal(x / 330.0F, y / 330.0F, 4, 0.5F, seed) - 0.35F * (1.0F - clear);
  return smoothstep(0.50F, 0.58F, growth);
}

ParcelHit Landscape::parcel_at(float x, float y) const {
  const Point bend = bend_at(x, y);
  return parcels.at(x + bend.x, y + bend.y);
}

}  // namespace overfly::terrain::synthesis
