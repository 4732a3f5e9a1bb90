// Buildings, tanks, vehicles and parked aircraft.
#pragma once

#include <vector>

#include "terrain/synthesis/landscape/airfield.hpp"
#include "terrain/synthesis/landscape/parcels.hpp"
#include "terrain/synthesis/landscape/water.hpp"

namespace overfly::terrain::synthesis {

enum class Roof : std::uint8_t { kGable, kFlat, kRound, kAircraft };

struct Structure {
  Point middle;
  float cos = 1.0F;  ///< direction of the long axis, from east towards north
  float sin = 0.0F;
  float half_length_m = 8.0F;
  float half_width_m = 5.0F;
  float height_m = 6.0F;
  Roof roof = Roof::kGable;
  Rgb colour;
  std::uint32_t seed = 0;

  /// Farthest point of the structure and its shadow from its centre.
  [[nodiscard]] float reach_m() const {
    return std::hypot(half_length_m, half_width_m) + 1.1F * height_m + 1.0F;
  }
};

/// Bare, trodden ground around buildings.
struct Yard {
  Point middle;
  float radius_m = 30.0F;
  std::uint32_t seed = 0;
  bool garden = false;  ///< grass and trees instead of gravel
};

struct Structures {
  std::vector<Structure> all;
  std::vector<Yard> yards;

  static Structures plan(float half_m,
                         const Airfield& airfield,
                         const Parcels& parcels,
                         const Water& water,
                         Dice& dice);
};

}  // namespace overfly::terrain::synthesis
