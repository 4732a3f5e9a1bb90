#include "terrain/synthesis/landscape/relief.hpp"

namespace overfly::terrain::synthesis {
namespace {

/// Hills before the other features, in about [0, 1].
float hills(float x, float y, std::uint32_t seed) {
  const float broad = noise(x / 1500.0F, y / 1500.0F, seed);
  const float ridges = fractal(x / 620.0F, y / 620.0F, 3, 0.42F, seed + 31);
  return 0.5F + 0.30F * broad + 0.32F * ridges;
}

}  // namespace

Relief Relief::plan(float half_m,
                    float reach_m,
                    float relief_m,
                    const Airfield& airfield,
                    const Water& water,
                    std::uint32_t seed) {
  Relief relief;
  const int half_posts = static_cast<int>(std::ceil((half_m + reach_m) / kPostM));
  relief.half_m_ = static_cast<float>(half_posts) * kPostM;
  relief.side_ = 2 * half_posts + 1;
  const int side = relief.side_;
  relief.heights_m_.resize(static_cast<std::size_t>(side) * side);
  const float level = hills(0.0F, 0.0F, seed);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const float x = static_cast<float>(column) * kPostM - relief.half_m_;
      const float y = relief.half_m_ - static_cast<float>(row) * kPostM;
      float height = hills(x, y, seed);
      // The stream lies in a valley, the airfield on level ground, ponds in hollows.
      const float stream = water.stream_m(x, y);
      height -= 0.22F * std::exp(-stream * stream / (170.0F * 170.0F));
      const Point uv = airfield.to_uv(x, y);
      const float free = smoothstep(0.0F, 320.0F, airfield.from_pavement_m(uv.x, uv.y));
      height = lerp(level, height, free);
      float metres = height * relief_m;
      const float shore = water.pond_m(x, y);
      if (shore < 30.0F) metres -= 1.2F * (1.0F - smoothstep(-5.0F, 30.0F, shore));
      relief.heights_m_[static_cast<std::size_t>(row) * side + column] = metres;
    }
  }
  relief.light_.resize(relief.heights_m_.size(), 1.0F);
  for (int row = 1; row + 1 < side; ++row) {
    for (int column = 1; column + 1 < side; ++column) {
      const std::size_t at = static_cast<std::size_t>(row) * side + column;
      const float east = (relief.heights_m_[at + 1] - relief.heights_m_[at - 1]) / (2.0F * kPostM);
      const float north =
          (relief.heights_m_[at - side] - relief.heights_m_[at + side]) / (2.0F * kPostM);
      const float cosine = (kSunUp - east * kSunEast - north * kSunNorth) /
                           std::sqrt(1.0F + east * east + north * north);
      relief.light_[at] = std::clamp(0.30F + 0.70F * cosine / kSunUp, 0.6F, 1.3F);
    }
  }
  return relief;
}

float Relief::light(float x, float y) const {
  const float u = std::clamp((x + half_m_) / kPostM, 0.0F, static_cast<float>(side_ - 2));
  const float v = std::clamp((half_m_ - y) / kPostM, 0.0F, static_cast<float>(side_ - 2));
  const int i = static_cast<int>(u);
  const int j = static_cast<int>(v);
  const float s = u - static_cast<float>(i);
  const float t = v - static_cast<float>(j);
  const float* row = light_.data() + static_cast<std::size_t>(j) * side_ + i;
  return lerp(lerp(row[0], row[1], s), lerp(row[side_], row[side_ + 1], s), t);
}

}  // namespace overfly::terrain::synthesis
