// The plan of the built-in world: all of its objects as shapes, before painting.
#pragma once

#include <vector>

#include "terrain/synthesis/landscape/airfield.hpp"
#include "terrain/synthesis/landscape/parcels.hpp"
#include "terrain/synthesis/landscape/relief.hpp"
#include "terrain/synthesis/landscape/structures.hpp"
#include "terrain/synthesis/landscape/water.hpp"

namespace overfly::terrain::synthesis {

struct LandscapeOptions {
  std::uint32_t seed = 1;
  float half_m = 2100.0F;   ///< half the side of the imagery
  float reach_m = 1500.0F;  ///< the hills extend this far beyond it
  float relief_m = 40.0F;
};

struct Landscape {
  LandscapeOptions options;
  Airfield airfield;
  Parcels parcels;
  Water water;
  Relief relief;
  Structures structures;

  static Landscape plan(const LandscapeOptions& options);

  /// The parcels of a place, with the old boundaries' bends.
  [[nodiscard]] ParcelHit parcel_at(float x, float y) const;
  /// Woods that do not depend on the fields, 0 to 1 with a soft edge.
  [[nodiscard]] float wood_at(float x, float y) const;
  /// How far boundaries bend away from straight lines here [m].
  [[nodiscard]] Point bend_at(float x, float y) const;
};

}  // namespace overfly::terrain::synthesis
