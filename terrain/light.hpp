// Light on the ground: hill shading, cast shadows and cloud shadows as a layer over any tiles.
//
// The imagery was photographed in light of its own: its shadows and its shading stay in it, and
// nothing here takes them out. What is added tells how the same ground would differ from flat,
// open ground under another sun. Steep slopes in shade in the photograph stay dark; trees and
// buildings, which are in the imagery and not in the elevation, cast no new shadows.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::terrain {

/// Shadows of fractal clouds. They stand still during a run.
struct CloudOptions {
  double cover = 0.0;      ///< share of the ground in shadow, in [0, 1]; 0 = no clouds
  double size_m = 400.0;   ///< of a typical cloud, in [20, 20000]
  double strength = 0.75;  ///< share of the direct light that a cloud takes, in [0, 1]
  std::uint64_t seed = 1;  ///< another seed, other clouds
};

struct LightOptions {
  double sun_azimuth_rad = 2.35619449;    ///< clockwise from north at the world's origin
  double sun_elevation_rad = 0.78539816;  ///< above the horizon, in [1 deg, 90 deg]
  /// Share of the light on open flat ground that comes from the sky and not from the sun, [0, 1].
  double ambient = 0.35;
  /// 0 = no hill shading, 1 = as physics has it, in [0, 1].
  double hill_shading = 1.0;
  /// 0 = no cast shadows, 1 = the direct light is gone in them, in [0, 1].
  double cast_shadows = 1.0;
  CloudOptions clouds;

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// The light that a slope receives over that of open flat ground, direct light unblocked:
///   1 + s (ambient + (1 - ambient) max(0, cos i) / sin e - 1),  at most kMaxLight,
/// i the angle between the normal and the sun, e the sun's elevation, s = hill_shading
/// (Lambert's cosine law; the sky's light is taken as the same from everywhere).
/// @param normal  upward unit normal, world frame
[[nodiscard]] double slope_light(const LightOptions& options, const Eigen::Vector3d& normal);

/// Brighter than this many times open flat ground nothing becomes: imagery has no more headroom.
inline constexpr double kMaxLight = 3.0;

/// Unit vector from the ground to the sun, world frame.
[[nodiscard]] Eigen::Vector3d sun_direction(const LightOptions& options);

/// The same tiles in another light. Texels are scaled in linear light (sRGB undone and redone).
/// Neighbouring tiles agree exactly; a level is the average of the one below but for how finely
/// each samples the light (figures in docs/WORLDS.md). Put detail synthesis around it, not below.
/// Deterministic and thread-safe as the tiles it covers.
/// Errors: kInvalidArgument as `validate`.
[[nodiscard]] Result<std::shared_ptr<const TileSource>> with_light(
    const std::shared_ptr<const TileSource>& tiles, const LightOptions& options);

/// One line for people: sun, shading, clouds.
[[nodiscard]] std::string describe(const LightOptions& options);

}  // namespace overfly::terrain
