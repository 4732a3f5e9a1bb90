// The airfield: runway, taxiway, apron, and the mown grass around them.
#pragma once

#include "terrain/synthesis/landscape/colour.hpp"
#include "terrain/synthesis/landscape/parcels.hpp"

namespace overfly::terrain::synthesis {

/// Coordinates on the airfield: u along the take-off run of the north end, from the runway's
/// middle; v to the right of that direction (west of a southbound runway).
struct Airfield {
  float heading_cos = -1.0F;  ///< of the take-off run: north component
  float heading_sin = 0.0F;   ///< east component
  float length_m = 1200.0F;
  float width_m = 30.0F;
  int designator = 18;  ///< runway number at the north end
  std::uint32_t seed = 0;

  static Airfield plan(float half_m, Dice& dice);

  [[nodiscard]] Point to_uv(float x, float y) const {
    return {x * heading_sin + y * heading_cos, x * heading_cos - y * heading_sin};
  }
  [[nodiscard]] Point to_xy(float u, float v) const {
    return {u * heading_sin + v * heading_cos, u * heading_cos - v * heading_sin};
  }
  /// Distance to the fence, negative inside.
  [[nodiscard]] float outside_m(float u, float v) const;
  /// Whether outside_m() is more than `distance_m`, where that is known without the fence's exact
  /// line; false where it is not.
  [[nodiscard]] bool surely_outside(float u, float v, float distance_m) const;
  /// The grass' and pavements' colour inside the fence.
  [[nodiscard]] Rgb colour(float u, float v, float x, float y) const;
  /// The runway's surface and paint, with the textures of the place.
  [[nodiscard]] Rgb runway_colour(float u, float v, float fine, float small, float middle) const;
  /// Distance from the pavements that must be level.
  [[nodiscard]] float from_pavement_m(float u, float v) const;

  [[nodiscard]] float half_length_m() const { return 0.5F * length_m; }
  [[nodiscard]] float taxiway_v_m() const { return 95.0F; }
  [[nodiscard]] float apron_half_m() const { return std::min(110.0F, 0.3F * length_m); }
  static constexpr float kApronNearM = 108.0F;
  static constexpr float kApronFarM = 190.0F;
};

}  // namespace overfly::terrain::synthesis
