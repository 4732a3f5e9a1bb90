// Light on the ground: hill shading, cast shadows and cloud shadows as a layer over any tiles.
//
// The imagery contains the light at the time of the photograph: its shadows and shading remain. The
// added light is the ratio between this ground and flat, open ground under another sun. Slopes that
// are dark in the photograph stay dark. Trees and buildings, which are in the imagery but not in
// the elevation, cast no new shadows.
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
  double strength = 0.75;  ///< fraction of the direct light that a cloud blocks, in [0, 1]
  std::uint64_t seed = 1;  ///< another seed gives other clouds
};

struct LightOptions {
  double sun_azimuth_rad = 2.35619449;    ///< clockwise from north at the world's origin
  double sun_elevation_rad = 0.78539816;  ///< above the horizon, in [1 deg, 90 deg]
  /// Fraction of the light on open flat ground that comes from the sky instead of the sun, [0, 1].
  double ambient = 0.35;
  /// 0 = no hill shading, 1 = physical, in [0, 1].
  double hill_shading = 1.0;
  /// 0 = no cast shadows, 1 = no direct light in them, in [0, 1].
  double cast_shadows = 1.0;
  CloudOptions clouds;

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// The light on a slope relative to open flat ground, with unobstructed direct light:
///   1 + s (ambient + (1 - ambient) max(0, cos i) / sin e - 1),  at most kMaxLight,
/// i = angle between normal and sun, e = the sun's elevation, s = hill_shading (Lambert's cosine
/// law; the light of the sky is assumed to be isotropic).
/// @param normal  upward unit normal, world frame
[[nodiscard]] double slope_light(const LightOptions& options, const Eigen::Vector3d& normal);

/// Upper limit of the light relative to open flat ground, since imagery has no more headroom.
inline constexpr double kMaxLight = 3.0;

/// Unit vector from the ground to the sun, world frame.
[[nodiscard]] Eigen::Vector3d sun_direction(const LightOptions& options);

/// The same tiles in another light. Texels are scaled in linear light (sRGB is decoded and
/// encoded). Neighbouring tiles agree exactly. A level is the average of the finer one, except for
/// the resolution at which each samples the light (figures in docs/WORLDS.md). Apply detail
/// synthesis on top of it, not below. Deterministic, and as thread-safe as the underlying tiles.
/// Errors: kInvalidArgument as `validate`.
[[nodiscard]] Result<std::shared_ptr<const TileSource>> with_light(
    const std::shared_ptr<const TileSource>& tiles, const LightOptions& options);

/// One line for people: sun, shading, clouds.
[[nodiscard]] std::string describe(const LightOptions& options);

}  // namespace overfly::terrain
