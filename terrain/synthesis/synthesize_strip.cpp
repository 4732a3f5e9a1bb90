#include "terrain/synthesize_strip.hpp"

#include <cmath>
#include <string>

#include "terrain/synthesis/landscape/landscape.hpp"
#include "terrain/synthesis/site.hpp"
#include "terrain/synthesis/strip_files.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

/// Side of the painted landscape; its mirror images make a period of twice that.
int swatch_px(const synthesis::Strip& strip) {
  constexpr int kLargestPx = 4096;
  constexpr double kSmallestM = 512.0;  // a landscape needs room for its airfield
  const int needed = static_cast<int>(std::ceil(kSmallestM / strip.texel_m));
  int side = synthesis::kStripStepPx;
  while (side < kLargestPx && (side < needed || side < strip.height_px)) side *= 2;
  return side;
}

Status check_strip(const StripOptions& options) {
  const struct {
    const char* name;
    double value, low, high;
  } limits[] = {{"length_m", options.length_m, 2000.0, 400e3},
                {"width_m", options.width_m, 1000.0, 20e3},
                {"texel_m", options.texel_m, 0.25, 5.0},
                {"post_m", options.post_m, 2.0, 100.0},
                {"relief_m", options.relief_m, 0.0, 400.0}};
  for (const auto& [name, value, low, high] : limits) {
    if (value >= low && value <= high) continue;
    char limit[64];
    std::snprintf(limit, sizeof(limit), "must be in [%g, %g]", low, high);
    return Error{ErrorCode::kInvalidArgument,
                 std::string(name) + " = " + std::to_string(value) + ": " + limit};
  }
  return {};
}

int side_px(double length_m, double texel_m) {
  constexpr double kHair = 1e-9;
  const double steps = std::ceil(length_m / texel_m / synthesis::kStripStepPx - kHair);
  return static_cast<int>(steps) * synthesis::kStripStepPx;
}

Status write_strip(const fs::path& folder, const StripOptions& options, const Progress& progress) {
  auto site = synthesis::choose_site();
  if (!site) return site.error();
  synthesis::Strip strip;
  strip.site = *site;
  strip.texel_m = options.texel_m;
  strip.width_px = side_px(options.length_m, options.texel_m);
  strip.height_px = side_px(options.width_m, options.texel_m);
  strip.left_x_m = site->middle_x_m - 0.5 * strip.width_px * options.texel_m;
  strip.top_y_m = site->middle_y_m + 0.5 * strip.height_px * options.texel_m;
  const int swatch = swatch_px(strip);
  synthesis::LandscapeOptions plan;
  plan.seed = static_cast<std::uint32_t>(options.seed ^ (options.seed >> 32U));
  plan.half_m = static_cast<float>(0.5 * swatch * options.texel_m);
  plan.relief_m = 30.0F;  // affects only the light on the painted slopes
  if (progress && !progress(0.0)) return Error{ErrorCode::kCancelled, "synthesis was cancelled"};
  constexpr double kPainting = 0.7;
  const auto part = [&progress](double from, double share) -> Progress {
    if (!progress) return {};
    return [&progress, from, share](double done) { return progress(from + share * done); };
  };
  const synthesis::Landscape land = synthesis::Landscape::plan(plan);
  Status done =
      synthesis::write_ground(folder / "ground.tif", land, strip, swatch, part(0.0, kPainting));
  if (done) done = synthesis::write_mosaic(folder, folder / "ground.tif", strip, swatch);
  if (done) {
    done = synthesis::write_hills(folder / "elevation.tif",
                                  strip,
                                  options.post_m,
                                  options.relief_m,
                                  plan.seed + 77U,
                                  part(kPainting, 1.0 - kPainting));
  }
  if (!done) return done;

  WorldSpec spec;
  const std::string credit = "Overfly strip world, synthesised";
  spec.name = "Strip, seed " + std::to_string(options.seed);
  spec.imagery.push_back({folder / "imagery.vrt", credit, {}});
  ElevationLayer elevation;
  elevation.file = folder / "elevation.tif";
  elevation.datum = VerticalDatum::kEllipsoid;
  elevation.attribution = credit;
  spec.elevation.push_back(elevation);
  return write_world_manifest(folder / "world.json", spec);
}

}  // namespace

Status synthesize_strip(const fs::path& folder,
                        const StripOptions& options,
                        const Progress& progress) {
  Status sane = check_strip(options);
  if (!sane) return sane;
  return synthesis::make_folder_whole(
      folder, [&](const fs::path& part) { return write_strip(part, options, progress); }, progress);
}

}  // namespace overfly::terrain
