// The colour of the open ground: fields, roads, yards, water, airfield.
#pragma once

#include <vector>

#include "terrain/decoration/noise_line.hpp"
#include "terrain/synthesis/landscape/landscape.hpp"

namespace overfly::terrain::synthesis {

/// Slowly varying quantities, computed on a coarse lattice and interpolated.
struct Slow {
  float bend_x = 0.0F;  ///< of the boundaries [m]
  float bend_y = 0.0F;
  float soil = 0.0F;      ///< variation of the soil, about [-1, 1], 20 m and more
  float patches = 0.0F;   ///< as soil, 4 m to 30 m
  float light = 1.0F;     ///< on the slope
  float stream_m = 0.0F;  ///< distance to the stream's middle
  float stream_half_m = 3.0F;
  float pond_m = 0.0F;  ///< distance to the shore
  float wood = 0.0F;    ///< share of woodland floor
  float drift = 1.0F;   ///< of brightness over the countryside
};

/// The fine textures shared by all ground, about [-1, 1] each.
struct Texture {
  float grain;  ///< a texel
  float clods;  ///< a metre
  float tufts;  ///< three metres
};

[[nodiscard]] Slow slow_at(const Landscape& land, float x, float y);
[[nodiscard]] Slow interpolate(const Slow& a, const Slow& b, float t);

/// Distance to a yard's ragged edge, negative inside.
[[nodiscard]] float yard_m(const Yard& yard, float x, float y);

/// Whether yard_m() is more than `distance_m`, where that is known without the exact edge; false
/// where it is not.
[[nodiscard]] bool surely_outside(const Yard& yard, float x, float y, float distance_m);

/// Paints the open ground along lines of texels from west to east.
class GroundPainter {
 public:
  /// @param yards  those that may reach a texel
  /// @param x      of the texels, ascending
  GroundPainter(const Landscape& land, std::vector<const Yard*> yards, const std::vector<float>& x);

  /// Goes to another line.
  void select_line(float y);
  [[nodiscard]] Rgb colour(std::size_t texel, const Slow& slow);

 private:
  /// Noise of one size at all texels of the line.
  struct Noise {
    Noise(float texels_per_m, const std::vector<float>& texels_x, std::uint32_t seed);
    void select_line(float y) { line.sample(x, y * per_m, values); }

    float per_m;
    std::vector<float> x;
    NoiseLine line;
    std::vector<float> values;
  };
  [[nodiscard]] Rgb field_colour(
      const ParcelHit& hit, const Slow& slow, const Texture& tex, float x, float y);

  const Landscape& land_;
  std::vector<const Yard*> yards_;
  std::vector<float> x_;
  float y_ = 0.0F;
  Noise fine_;
  Noise coarse_;
  Noise clods_;
  Noise tufts_;
  NoiseInCell vigour_;
  NoiseInCell thin_;
};

}  // namespace overfly::terrain::synthesis
