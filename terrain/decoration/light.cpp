#include "terrain/decoration/light.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/motion/pose.hpp"

namespace overfly::terrain {
namespace {

Error bad_light(const char* field, double value, const char* limits) {
  char text[160];
  std::snprintf(text, sizeof(text), "light.%s = %g: must be in %s", field, value, limits);
  return {ErrorCode::kInvalidArgument, text};
}

bool in(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

Status LightOptions::validate() const {
  const double azimuth_deg = deg_from_rad(sun_azimuth_rad);
  const double elevation_deg = deg_from_rad(sun_elevation_rad);
  constexpr double kHair = 1e-9;
  if (!in(azimuth_deg, -360.0, 720.0)) {
    return bad_light("sun_azimuth_deg", azimuth_deg, "[-360, 720]");
  }
  if (!in(elevation_deg, 1.0 - kHair, 90.0 + kHair)) {
    return bad_light(
        "sun_elevation_deg", elevation_deg, "[1, 90]: the sun must be above the horizon");
  }
  if (!in(ambient, 0.0, 1.0)) return bad_light("ambient", ambient, "[0, 1]");
  if (!in(hill_shading, 0.0, 1.0)) return bad_light("hill_shading", hill_shading, "[0, 1]");
  if (!in(cast_shadows, 0.0, 1.0)) return bad_light("cast_shadows", cast_shadows, "[0, 1]");
  if (!in(clouds.cover, 0.0, 1.0)) return bad_light("clouds.cover", clouds.cover, "[0, 1]");
  if (!in(clouds.size_m, 20.0, 20000.0)) {
    return bad_light("clouds.size_m", clouds.size_m, "[20, 20000]");
  }
  if (!in(clouds.strength, 0.0, 1.0)) {
    return bad_light("clouds.strength", clouds.strength, "[0, 1]");
  }
  return {};
}

Eigen::Vector3d sun_direction(const LightOptions& options) {
  const double level = std::cos(options.sun_elevation_rad);
  return {level * std::sin(options.sun_azimuth_rad),
          level * std::cos(options.sun_azimuth_rad),
          std::sin(options.sun_elevation_rad)};
}

std::string describe(const LightOptions& options) {
  char text[320];
  int length = std::snprintf(text,
                             sizeof(text),
                             "sun at azimuth %.2f deg, elevation %.2f deg; ambient %g, hill "
                             "shading %g, cast shadows %g",
                             deg_from_rad(options.sun_azimuth_rad),
                             deg_from_rad(options.sun_elevation_rad),
                             options.ambient,
                             options.hill_shading,
                             options.cast_shadows);
  if (options.clouds.cover > 0.0) {
    length = std::clamp(length, 0, static_cast<int>(sizeof(text)) - 1);
    std::snprintf(text + length,
                  sizeof(text) - static_cast<std::size_t>(length),
                  "; cloud shadows over %g %% of the ground, %g m, strength %g, seed %llu",
                  100.0 * options.clouds.cover,
                  options.clouds.size_m,
                  options.clouds.strength,
                  static_cast<unsigned long long>(options.clouds.seed));
  }
  return text;
}

}  // namespace overfly::terrain
