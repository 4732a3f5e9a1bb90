#include "terrain/synthesis/landscape/airfield.hpp"

#include <array>

namespace overfly::terrain::synthesis {
namespace {

/// The fence: a rectangle with a ragged line [m].
constexpr float kFenceU = 75.0F;  ///< beyond the runway's ends
constexpr float kFenceLowV = -85.0F;
constexpr float kFenceHighV = 255.0F;
constexpr float kFenceRaggednessM = 6.0F;

/// Distance to a rectangle |u| <= half_u, low_v <= v <= high_v; negative inside.
float rect_m(float u, float v, float half_u, float low_v, float high_v) {
  const float du = std::abs(u) - half_u;
  const float dv = std::max(low_v - v, v - high_v);
  if (du <= 0.0F || dv <= 0.0F) return std::max(du, dv);
  return std::hypot(du, dv);
}

/// Coverage by paint or pavement, soft over a texel.
float inside(float distance_m, float soft_m = 0.18F) {
  return std::clamp(0.5F - 0.5F * distance_m / soft_m, 0.0F, 1.0F);
}

/// Seven-segment runway digits, 9 m tall; du, dv from the digit's middle, up = +du.
bool digit(int value, float du, float dv) {
  static constexpr std::array<std::uint8_t, 10> kSegments = {
      0x77, 0x24, 0x5d, 0x6d, 0x2e, 0x6b, 0x7b, 0x25, 0x7f, 0x6f};
  constexpr float kHalfWidth = 1.7F;
  constexpr float kHalfHeight = 4.5F;
  constexpr float kStroke = 0.45F;
  if (std::abs(du) > kHalfHeight + kStroke || std::abs(dv) > kHalfWidth + kStroke) return false;
  const std::uint8_t on = kSegments[static_cast<std::size_t>(value % 10)];
  const auto bit = [&](int i) { return ((on >> i) & 1) != 0; };
  if (bit(0) && std::abs(du - kHalfHeight) < kStroke) return true;
  if (bit(3) && std::abs(du) < kStroke) return true;
  if (bit(6) && std::abs(du + kHalfHeight) < kStroke) return true;
  const bool upper = du > 0.0F;
  if (std::abs(dv + kHalfWidth) < kStroke) return bit(upper ? 1 : 4);
  if (std::abs(dv - kHalfWidth) < kStroke) return bit(upper ? 2 : 5);
  return false;
}

/// White paint of one runway end; e = distance inwards from the threshold, s = to the right when
/// landing over it.
float end_marking(float e, float s, float width_m, int number) {
  const float half = 0.5F * width_m;
  if (e > 6.0F && e < 36.0F && std::abs(s) < half - 2.0F && std::abs(s) > 1.2F) {
    const float bar = std::fmod(std::abs(s) - 1.2F, 3.6F);
    return inside(std::abs(bar - 0.9F) - 0.9F);
  }
  if (e > 48.0F && e < 62.0F) {
    const bool painted =
        digit(number / 10, e - 55.0F, s + 3.1F) || digit(number % 10, e - 55.0F, s - 3.1F);
    return painted ? 1.0F : 0.0F;
  }
  if (e > 150.0F && e < 195.0F) return inside(std::abs(std::abs(s) - 7.0F) - 2.2F);
  return 0.0F;
}

}  // namespace

Airfield Airfield::plan(float half_m, Dice& dice) {
  Airfield airfield;
  airfield.length_m = std::clamp(0.58F * half_m, 150.0F, 1200.0F);
  const float heading_deg = 180.0F + dice.between(-9.0F, 9.0F);
  airfield.heading_cos = std::cos(heading_deg * 0.01745329252F);
  airfield.heading_sin = std::sin(heading_deg * 0.01745329252F);
  airfield.designator = static_cast<int>(std::lround(heading_deg / 10.0F));
  airfield.seed = dice.seed();
  return airfield;
}

float Airfield::outside_m(float u, float v) const {
  return rect_m(u, v, half_length_m() + kFenceU, kFenceLowV, kFenceHighV) +
         kFenceRaggednessM * noise(0.01F * u, 0.01F * v, seed);
}

bool Airfield::surely_outside(float u, float v, float distance_m) const {
  constexpr float kRoundingM = 0.1F;
  const float beyond_m = distance_m + kFenceRaggednessM + kRoundingM;
  return std::abs(u) - half_length_m() - kFenceU > beyond_m || kFenceLowV - v > beyond_m ||
         v - kFenceHighV > beyond_m;
}

float Airfield::from_pavement_m(float u, float v) const {
  return rect_m(u, v, half_length_m() + 40.0F, -50.0F, 230.0F);
}

Rgb Airfield::runway_colour(float u, float v, float fine, float small, float middle) const {
  // Asphalt with repairs, cracks, tyre marks and paint.
  const float half = half_length_m();
  const float patch =
      unit(hash(floor_int(u / 47.0F), floor_int((v + 60.0F) / 7.5F), seed + 5)) - 0.5F;
  const float streak = noise(u * 0.03F, v * 1.3F, seed + 6);
  const float joint = inside(std::abs(std::fmod(std::abs(v), 7.5F) - 3.75F) - 0.06F, 0.15F);
  const float crack = std::abs(noise(u * 0.21F, v * 0.21F, seed + 7) + 0.25F * small);
  Rgb asphalt = Rgb{112, 112, 110} * (1.0F + 0.07F * patch + 0.04F * streak + 0.035F * fine +
                                      0.035F * small + 0.04F * middle);
  asphalt = asphalt * (1.0F - 0.10F * joint - 0.12F * inside(crack - 0.012F, 0.012F));
  const float end = half - std::abs(u);
  const float rubber = smoothstep(60.0F, 160.0F, end) * (1.0F - smoothstep(230.0F, 420.0F, end)) *
                       std::exp(-0.02F * v * v) * (0.75F + 0.35F * streak);
  asphalt = asphalt * (1.0F - 0.38F * rubber);
  float paint = 0.0F;
  paint = std::max(paint, inside(std::abs(std::abs(v) - 0.5F * width_m + 1.0F) - 0.45F));
  if (end > 75.0F && std::fmod(u + 2000.0F, 50.0F) < 30.0F) {
    paint = std::max(paint, inside(std::abs(v) - 0.4F));
  }
  // Landing at the north end, the view is along +u with +v to the right.
  paint = std::max(paint,
                   u < 0.0F ? end_marking(u + half, v, width_m, designator)
                            : end_marking(half - u, -v, width_m, (designator + 17) % 36 + 1));
  const float wear = std::clamp(0.80F + 0.3F * small - 0.45F * rubber, 0.0F, 1.0F);
  return mix(asphalt, {222, 222, 214}, paint * wear);
}

Rgb Airfield::colour(float u, float v, float x, float y) const {
  const float fine = noise(x * 2.9F, y * 2.9F, seed + 1);
  const float small = noise(x * 1.1F, y * 1.1F, seed + 2);
  const float middle = fractal(x * 0.16F, y * 0.16F, 3, 0.6F, seed + 3);
  const float large = fractal(x * 0.017F, y * 0.017F, 3, 0.6F, seed + 4);

  // Mown grass in passes, drier on the thin soil next to the pavements.
  const int pass = floor_int(v / 7.5F);
  const float stripe = (pass & 1) != 0 ? 0.022F : -0.022F;
  const float dry = smoothstep(-0.5F, 0.9F, large + 0.45F * middle + 0.2F * small);
  Rgb ground = mix({104, 114, 70}, {158, 148, 104}, dry);
  ground = ground * (1.0F + stripe + 0.075F * fine + 0.06F * small + 0.05F * middle);

  const float half = half_length_m();
  const float taxi = taxiway_v_m();
  const auto pave = [&](float distance, const Rgb& colour, float edge_m) {
    const float worn = edge_m * (0.5F * small + 0.5F * middle);
    ground = mix(ground, colour, inside(distance + worn));
  };
  // Taxiway with its links, then the apron, in old concrete.
  const float seams_u = std::abs(std::fmod(std::abs(u), 6.0F) - 3.0F);
  const float seams_v = std::abs(std::fmod(std::abs(v), 6.0F) - 3.0F);
  const float seam = std::max(inside(2.86F - seams_u, 0.12F), inside(2.86F - seams_v, 0.12F));
  const float slab =
      unit(hash(floor_int((u + 3.0F) / 6.0F), floor_int((v + 3.0F) / 6.0F), seed)) - 0.5F;
  const Rgb concrete = Rgb{170, 167, 158} * (1.0F + 0.07F * slab + 0.035F * fine + 0.05F * middle -
                                             0.16F * seam + 0.05F * large);
  const float rough = unit(hash(floor_int(u / 31.0F), 3, seed)) - 0.5F;
  const Rgb taxi_asphalt =
      Rgb{126, 126, 123} * (1.0F + 0.045F * fine + 0.05F * middle + 0.08F * rough);
  pave(rect_m(u, v - taxi, half, -5.5F, 5.5F), taxi_asphalt, 0.5F);
  for (const float link : {-half + 9.0F, 0.12F * half, half - 9.0F}) {
    pave(rect_m(u - link, v, 5.5F, 0.0F, taxi), taxi_asphalt, 0.5F);
  }
  pave(rect_m(u, v, apron_half_m(), taxi, kApronFarM), concrete, 0.3F);
  const float guide =
      std::min(std::abs(v - taxi),
               std::abs(v - taxi - 45.0F) + (std::abs(u) > apron_half_m() ? 9.0F : 0.0F));
  if (std::abs(u) < half) ground = mix(ground, {196, 170, 70}, 0.7F * inside(guide - 0.10F));

  const float runway = rect_m(u, v, half, -0.5F * width_m, 0.5F * width_m);
  if (runway > 1.0F) return ground;
  return mix(ground, runway_colour(u, v, fine, small, middle), inside(runway));
}

}  // namespace overfly::terrain::synthesis
