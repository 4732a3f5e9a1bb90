#include "terrain/synthesis/landscape/ground.hpp"

#include <limits>
#include <utility>

namespace overfly::terrain::synthesis {
namespace {

/// A yard's edge varies by this share of its radius.
constexpr float kYardRaggedness = 0.22F;
/// A yard colours the ground up to this distance from its edge.
constexpr float kYardRimM = 4.0F;
/// The fence colours the ground up to this distance outside.
constexpr float kFenceRimM = 3.0F;

float wrap(float value, float period) { return value - period * std::floor(value / period); }

Rgb grass_colour(const Slow& slow, const Texture& tex) {
  const float dry = smoothstep(-0.8F, 0.9F, slow.soil + 0.7F * slow.patches + 0.4F * tex.tufts);
  return mix({92, 104, 60}, {148, 142, 96}, dry) *
         (1.0F + 0.10F * tex.grain + 0.09F * tex.clods + 0.06F * tex.tufts);
}

/// A road's surface, blended into the ground next to it.
Rgb road_colour(const Rgb& surroundings,
                const ParcelHit& hit,
                const Slow& slow,
                const Texture& tex) {
  const float m = hit.road_m;
  const float ragged = 0.25F * tex.clods + 0.25F * tex.tufts;
  if (hit.road == Border::kRoad) {
    Rgb colour = mix(surroundings, grass_colour(slow, tex), soft(m - 7.5F - ragged, 0.5F));
    colour = mix(colour, {168, 158, 138}, soft(m - 4.6F - ragged, 0.4F));
    const float lane = std::abs(m - 1.8F);
    const float patch =
        unit(hash(floor_int(hit.road_along_m / 37.0F), hit.road_signed_m > 0.0F ? 1 : 0, 91)) -
        0.5F;
    const Rgb asphalt =
        Rgb{128, 127, 125} * (1.0F + 0.05F * tex.grain + 0.05F * tex.tufts + 0.09F * patch -
                              0.06F * soft(std::abs(lane - 0.8F) - 0.3F, 0.4F));
    colour = mix(colour, asphalt, soft(m - 3.6F - 0.3F * ragged));
    colour = mix(colour, {206, 206, 200}, 0.7F * soft(std::abs(m - 3.25F) - 0.09F));
    const bool dash = wrap(hit.road_along_m, 12.0F) < 4.5F;
    return mix(colour, {206, 190, 110}, (dash ? 0.85F : 0.0F) * soft(m - 0.09F));
  }
  if (hit.road == Border::kGravelRoad) {
    Rgb colour = mix(surroundings, grass_colour(slow, tex), soft(m - 5.0F - ragged, 0.5F));
    const float rut = soft(std::abs(m - 0.95F) - 0.4F, 0.3F);
    const Rgb gravel = Rgb{186, 174, 150} * (1.0F + 0.07F * tex.grain + 0.05F * tex.clods +
                                             0.06F * slow.patches + 0.06F * rut);
    return mix(colour, gravel, soft(m - 2.7F - 1.4F * ragged, 0.4F));
  }
  Rgb colour = mix(surroundings, grass_colour(slow, tex), soft(m - 3.0F - 2.0F * ragged, 0.6F));
  const float rut = soft(std::abs(m - 0.85F) - 0.33F - 0.2F * tex.tufts, 0.25F);
  return mix(colour, Rgb{178, 160, 126} * (1.0F + 0.08F * tex.grain), 0.85F * rut);
}

Rgb border_colour(const Rgb& field, const ParcelHit& hit, const Slow& slow, const Texture& tex) {
  const float m = hit.border_m;
  const float ragged = 0.5F * tex.clods + 0.8F * tex.tufts;
  switch (hit.border) {
    case Border::kHedge:
      return mix(field, grass_colour(slow, tex) * 0.9F, soft(m - 3.2F - ragged, 0.7F));
    case Border::kMargin:
      return mix(field, grass_colour(slow, tex), soft(m - 1.6F - 0.6F * ragged, 0.5F));
    case Border::kDitch: {
      const Rgb bank = mix(field, grass_colour(slow, tex), soft(m - 3.4F - 0.6F * ragged, 0.6F));
      return mix(bank, {58, 64, 44}, 0.85F * soft(m - 0.7F - 0.3F * ragged, 0.3F));
    }
    default:
      return field;
  }
}

Rgb yard_colour(
    const Rgb& around, const Yard& yard, float distance_m, const Slow& slow, const Texture& tex) {
  if (yard.garden) {
    const Rgb lawn =
        Rgb{104, 122, 68} * (1.0F + 0.07F * tex.grain + 0.07F * tex.tufts + 0.05F * slow.patches);
    return mix(around, lawn, soft(distance_m, 0.6F));
  }
  const float worn = smoothstep(-0.9F, 0.7F, slow.patches + 0.6F * tex.tufts + 0.3F * tex.clods);
  const Rgb ground =
      mix({132, 126, 92}, {188, 176, 152}, worn) * (1.0F + 0.07F * tex.grain + 0.06F * tex.clods);
  return mix(around, ground, soft(distance_m + 1.5F * tex.tufts, 1.0F));
}

Rgb water_colour(
    const Rgb& bank, float inside_m, float deep_m, const Texture& tex, float x, float y) {
  // Shallows over mud, then water that reflects a uniform sky: poor texture for any tracker.
  const float depth = smoothstep(0.0F, deep_m, inside_m);
  const float ripple = 0.6F * noise(x * 0.05F, y * 0.11F, 321) + 0.15F * tex.clods;
  const Rgb water = mix({92, 94, 72}, {52, 66, 66}, depth) * (1.0F + 0.035F * ripple);
  return mix(bank, water, soft(-inside_m, 0.3F));
}

std::vector<float> scaled(std::vector<float> values, float factor) {
  for (float& value : values) value *= factor;
  return values;
}

}  // namespace

Slow slow_at(const Landscape& land, float x, float y) {
  Slow slow;
  const Point bend = land.bend_at(x, y);
  const std::uint32_t seed = land.water.seed + 80;
  slow.bend_x = bend.x;
  slow.bend_y = bend.y;
  // Old watercourses appear as dark, winding bands in the soil.
  const float swale = std::abs(fractal(x / 240.0F, y / 240.0F, 3, 0.55F, seed + 20));
  slow.soil = 1.2F * fractal(x / 170.0F, y / 170.0F, 4, 0.62F, seed) -
              0.55F * (1.0F - smoothstep(0.02F, 0.13F, swale));
  slow.wood = land.wood_at(x, y);
  slow.drift = 1.0F + 0.07F * fractal(x / 610.0F, y / 610.0F, 3, 0.5F, seed + 30);
  slow.patches = 1.3F * fractal(x / 26.0F, y / 26.0F, 3, 0.66F, seed + 9);
  slow.light = land.relief.light(x, y);
  slow.stream_m = land.water.stream_m(x, y);
  slow.stream_half_m = land.water.stream_half_width_m(y);
  slow.pond_m = land.water.pond_m(x, y);
  return slow;
}

Slow interpolate(const Slow& a, const Slow& b, float t) {
  Slow slow;
  slow.bend_x = lerp(a.bend_x, b.bend_x, t);
  slow.bend_y = lerp(a.bend_y, b.bend_y, t);
  slow.soil = lerp(a.soil, b.soil, t);
  slow.patches = lerp(a.patches, b.patches, t);
  slow.light = lerp(a.light, b.light, t);
  slow.stream_m = lerp(a.stream_m, b.stream_m, t);
  slow.stream_half_m = lerp(a.stream_half_m, b.stream_half_m, t);
  slow.pond_m = lerp(a.pond_m, b.pond_m, t);
  slow.wood = lerp(a.wood, b.wood, t);
  slow.drift = lerp(a.drift, b.drift, t);
  return slow;
}

float yard_m(const Yard& yard, float x, float y) {
  const float distance = std::hypot(x - yard.middle.x, y - yard.middle.y);
  return distance -
         yard.radius_m * (1.0F + kYardRaggedness * noise(x / 17.0F, y / 17.0F, yard.seed));
}

bool surely_outside(const Yard& yard, float x, float y, float distance_m) {
  constexpr float kRoundingM = 0.1F;
  const float reach_m = (1.0F + kYardRaggedness) * yard.radius_m + distance_m + kRoundingM;
  const float dx = x - yard.middle.x;
  const float dy = y - yard.middle.y;
  return dx * dx + dy * dy > reach_m * reach_m;
}

GroundPainter::Noise::Noise(float texels_per_m,
                            const std::vector<float>& texels_x,
                            std::uint32_t seed)
    : per_m(texels_per_m),
      x(scaled(texels_x, per_m)),
      line(x.front(), x.back(), seed),
      values(x.size()) {}

GroundPainter::GroundPainter(const Landscape& land,
                             std::vector<const Yard*> yards,
                             const std::vector<float>& x)
    : land_(land),
      yards_(std::move(yards)),
      x_(x),
      fine_(3.1F, x, land.water.seed + 17),
      coarse_(1.65F, x, land.water.seed + 18),
      clods_(0.83F, x, land.water.seed + 19),
      tufts_(0.31F, x, land.water.seed + 20) {}

void GroundPainter::select_line(float y) {
  y_ = y;
  for (Noise* noise : {&fine_, &coarse_, &clods_, &tufts_}) noise->select_line(y);
}

Rgb GroundPainter::field_colour(
    const ParcelHit& hit, const Slow& slow, const Texture& tex, float x, float y) {
  const Parcel& parcel = *hit.parcel;
  // The machine turns on the headland, and the rows follow the boundary.
  const float headland_m = 2.0F * parcel.pass_width_m;
  const bool headland = parcel.pass_contrast > 0.0F && hit.border_m < headland_m;
  const float across = headland ? hit.border_m : -parcel.row_sin * x + parcel.row_cos * y;
  const float along = headland ? hit.along_m : parcel.row_cos * x + parcel.row_sin * y;

  const float soil =
      0.5F + parcel.blotch * (0.75F * slow.soil + 0.45F * slow.patches) + 0.10F * tex.tufts;
  Rgb colour = mix(parcel.dark, parcel.light, std::clamp(soil, -0.15F, 1.15F));

  float shade = 1.0F;
  const int pass = floor_int(across / parcel.pass_width_m);
  const float hand = unit(hash(pass, headland ? 1 : 0, parcel.seed)) - 0.5F;
  shade +=
      parcel.pass_contrast * ((pass & 1) != 0 ? 1.0F : -1.0F) + 1.3F * parcel.pass_contrast * hand;
  if (parcel.row_contrast > 0.0F) {
    const float phase = wrap(across / parcel.row_spacing_m, 1.0F);
    const float wave = 1.0F - 4.0F * std::abs(phase - 0.5F);
    const float vigour = 0.65F + 0.5F * vigour_.at(along * 0.12F, across * 0.6F, parcel.seed + 5) +
                         0.25F * tex.clods;
    shade += parcel.row_contrast * wave * vigour;
    const int row = floor_int(across / parcel.row_spacing_m);
    shade += 0.5F * parcel.row_contrast *
             (unit(hash(row, floor_int(along / 23.0F), parcel.seed + 6)) - 0.5F);
  }
  const float thin = thin_.at(x * 0.075F, y * 0.075F, parcel.seed + 7) + 0.55F * tex.tufts +
                     0.35F * tex.clods + 0.8F * slow.patches;
  const float bare = parcel.bare * smoothstep(0.75F, 1.35F, thin);
  colour = mix(colour, {176, 156, 124}, bare);
  if (parcel.tramline_m > 0.0F) {
    const float offset = wrap(across, parcel.tramline_m) - 0.5F * parcel.tramline_m;
    const float wheel = std::abs(std::abs(offset) - 0.95F) - 0.28F;
    colour = mix(colour,
                 parcel.use == LandUse::kCrop ? Rgb{112, 104, 74} : Rgb{150, 134, 104},
                 0.7F * soft(wheel));
  }
  shade += parcel.grain * (0.75F * tex.grain + 0.55F * tex.clods + 0.35F * tex.tufts);
  return colour * shade;
}

Rgb GroundPainter::colour(std::size_t texel, const Slow& slow) {
  const float x = x_[texel];
  const float y = y_;
  const Point uv = land_.airfield.to_uv(x, y);
  const float outside = land_.airfield.surely_outside(uv.x, uv.y, kFenceRimM)
                            ? std::numeric_limits<float>::max()
                            : land_.airfield.outside_m(uv.x, uv.y);
  if (outside < -9.0F) return land_.airfield.colour(uv.x, uv.y, x, y) * (slow.light * slow.drift);
  const Texture tex{0.6F * fine_.values[texel] + 0.55F * coarse_.values[texel],
                    clods_.values[texel],
                    tufts_.values[texel]};

  const float bent_x = x + slow.bend_x;
  const float bent_y = y + slow.bend_y;
  const ParcelHit hit = land_.parcels.at(bent_x, bent_y);
  Rgb colour = field_colour(hit, slow, tex, bent_x, bent_y);
  colour = border_colour(colour, hit, slow, tex);
  if (slow.wood > 0.0F) colour = mix(colour, grass_colour(slow, tex) * 0.8F, slow.wood);
  const bool track = hit.road == Border::kTrack;
  if (track && hit.road_m < 9.0F) colour = road_colour(colour, hit, slow, tex);
  for (const Yard* yard : yards_) {
    if (surely_outside(*yard, x, y, kYardRimM)) continue;
    const float distance = yard_m(*yard, x, y);
    if (distance < kYardRimM) colour = yard_colour(colour, *yard, distance, slow, tex);
  }
  const float in_stream = slow.stream_half_m - slow.stream_m;
  const float in_pond = -slow.pond_m;
  const float wet = std::max(in_stream, in_pond);
  if (wet > -14.0F) {
    const Rgb reeds = grass_colour(slow, tex) * 0.82F;
    colour = mix(colour, reeds, soft(-wet - 7.0F - 2.5F * tex.tufts, 1.6F));
    colour = mix(colour, {152, 138, 108}, 0.7F * soft(-wet - 1.2F - 0.8F * tex.clods, 0.5F));
    colour = water_colour(colour, wet, in_pond > in_stream ? 7.0F : 2.4F, tex, x, y);
  }
  if (!track && hit.road_m < 9.0F) colour = road_colour(colour, hit, slow, tex);
  if (outside < kFenceRimM) {
    // The fence's line, the track inside it, and the grass up to the airfield's own.
    const Rgb grass = grass_colour(slow, tex);
    colour = mix(colour, grass, soft(outside - 1.5F, 0.8F));
    const float rut = std::abs(std::abs(outside + 5.0F) - 0.85F) - 0.4F;
    colour = mix(colour, {176, 162, 132}, 0.8F * soft(rut, 0.3F));
  }
  return colour * (slow.light * slow.drift);
}

}  // namespace overfly::terrain::synthesis
