// The hills: heights on a grid of posts, and the light on their slopes.
#pragma once

#include <vector>

#include "terrain/synthesis/landscape/airfield.hpp"
#include "terrain/synthesis/landscape/water.hpp"

namespace overfly::terrain::synthesis {

/// Direction towards the sun (east, north, up): a summer morning.
inline constexpr float kSunEast = 0.485F;
inline constexpr float kSunNorth = -0.545F;
inline constexpr float kSunUp = 0.684F;

/// Shadow of a point one metre above the ground.
inline constexpr float kShadowEast = -kSunEast / kSunUp;
inline constexpr float kShadowNorth = -kSunNorth / kSunUp;

class Relief {
 public:
  static constexpr float kPostM = 5.0F;

  static Relief plan(float half_m,
                     float reach_m,
                     float relief_m,
                     const Airfield& airfield,
                     const Water& water,
                     std::uint32_t seed);

  /// Brightness of level ground's light on the slope here, about [0.7, 1.2].
  [[nodiscard]] float light(float x, float y) const;

  /// Posts from the north-west corner, row by row [m above the world's base height].
  [[nodiscard]] const std::vector<float>& heights_m() const { return heights_m_; }
  [[nodiscard]] int side_posts() const { return side_; }
  /// Distance from the middle to the outermost posts.
  [[nodiscard]] float half_m() const { return half_m_; }

 private:
  std::vector<float> heights_m_;
  std::vector<float> light_;
  int side_ = 0;
  float half_m_ = 0.0F;
};

}  // namespace overfly::terrain::synthesis
