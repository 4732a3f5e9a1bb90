#include "server/scenario/document/scenario_light.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <string>
#include <utility>

#include "core/earth/sun_position.hpp"
#include "core/time.hpp"
#include "server/scenario/document/scenario_field.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// Parses "2026-06-21T17:30Z", or with seconds, as Unix time.
Result<std::int64_t> unix_ns_from(const std::string& text, const std::string& path) {
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  int hour = 0;
  int minute = 0;
  int second = 0;
  std::sscanf(text.c_str(), "%d-%u-%uT%d:%d:%d", &year, &month, &day, &hour, &minute, &second);
  const std::chrono::year_month_day date{
      std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  if (!date.ok() || hour > 23 || minute > 59 || second > 59) {
    return bad_field(path, text, "be a date and time that exist");
  }
  // The range of Unix time in 64-bit nanoseconds.
  if (year < 1678 || year > 2261) return bad_field(path, text, "be in the years 1678 to 2261");
  const auto days = std::chrono::sys_days(date).time_since_epoch();
  const std::chrono::seconds total =
      days + std::chrono::hours(hour) + std::chrono::minutes(minute) + std::chrono::seconds(second);
  return total.count() * kNsPerS;
}

Status read_light(const Json& light, LightSpec& spec) {
  terrain::LightOptions& options = spec.options;
  if (light.contains("time_utc")) {
    if (light.contains("sun_azimuth_deg")) {
      return bad_field(
          "light.time_utc", light.at("time_utc"), "not be given with light.sun_azimuth_deg");
    }
    const auto time = unix_ns_from(light.at("time_utc").get<std::string>(), "light.time_utc");
    if (!time) return time.error();
    spec.time_unix_ns = *time;
  }
  if (light.contains("sun_azimuth_deg")) {
    options.sun_azimuth_rad = rad_from_deg(light.at("sun_azimuth_deg").get<double>());
    options.sun_elevation_rad = rad_from_deg(light.at("sun_elevation_deg").get<double>());
  }
  options.ambient = light.at("ambient").get<double>();
  options.hill_shading = light.at("hill_shading").get<double>();
  options.cast_shadows = light.at("cast_shadows").get<double>();
  const Json& clouds = light.at("clouds");
  options.clouds.cover = clouds.at("cover").get<double>();
  options.clouds.size_m = clouds.at("size_m").get<double>();
  options.clouds.strength = clouds.at("strength").get<double>();
  options.clouds.seed = clouds.at("seed").get<std::uint64_t>();
  if (Status valid = options.validate(); !valid) return valid.error().in("light");
  return {};
}

/// Light with the sun's position as seen from the world's origin.
Result<terrain::LightOptions> light_over(const LightSpec& spec, const Geodetic& origin) {
  terrain::LightOptions options = spec.options;
  if (!spec.time_unix_ns) return options;
  const SunPosition sun = sun_position(*spec.time_unix_ns, origin);
  constexpr double kLowestDeg = 1.0;
  if (sun.apparent_elevation_rad < rad_from_deg(kLowestDeg)) {
    return Error{ErrorCode::kInvalidArgument,
                 "light.time_utc: the sun is " +
                     std::to_string(deg_from_rad(sun.apparent_elevation_rad)) +
                     "deg above the horizon at that time: must be at least 1 deg"};
  }
  options.sun_azimuth_rad = sun.azimuth_rad;
  options.sun_elevation_rad = sun.apparent_elevation_rad;
  return options;
}

}  // namespace

Status read_light_and_detail(const Json& document, Scenario& scenario) {
  if (document.contains("light")) {
    scenario.light.emplace();
    if (Status status = read_light(document.at("light"), *scenario.light); !status) return status;
  }
  if (!document.contains("detail")) return {};
  const Json& detail = document.at("detail");
  terrain::DetailOptions options;
  options.octaves = detail.at("octaves").get<int>();
  options.strength = detail.at("strength").get<double>();
  options.seed = detail.at("seed").get<std::uint64_t>();
  if (Status valid = options.validate(); !valid) return valid.error().in("detail");
  scenario.detail = options;
  return {};
}

void read_renderer(const Json& document, Scenario& scenario) {
  const Json& renderer = document.at("renderer");
  scenario.renderer.camera = renderer.at("camera").get<std::string>();
  scenario.renderer.device = renderer.at("device").get<std::string>();
  scenario.renderer.threads = renderer.at("threads").get<int>();
}

Result<WorldDress> world_dress(const Scenario& scenario, const Geodetic& origin) {
  WorldDress dress;
  if (scenario.light) {
    const auto options = light_over(*scenario.light, origin);
    if (!options) return options.error();
    dress.emplace_back("light", terrain::describe(*options));
  }
  if (scenario.detail) dress.emplace_back("detail", terrain::describe(*scenario.detail));
  return dress;
}

Status dress_world(const Scenario& scenario, terrain::World& world) {
  if (scenario.light) {
    const auto options = light_over(*scenario.light, world.tiles->frame().origin());
    if (!options) return options.error();
    auto lit = terrain::with_light(world.tiles, *options);
    if (!lit) return lit.error().in("light");
    world.tiles = std::move(*lit);
  }
  if (scenario.detail) {
    auto detailed = terrain::with_detail(world.tiles, *scenario.detail);
    if (!detailed) return detailed.error().in("detail");
    world.tiles = std::move(*detailed);
  }
  return {};
}

}  // namespace overfly::server
