// A block of the image being painted: colour and shadow of each texel.
#pragma once

#include <vector>

#include "terrain/synthesis/landscape/colour.hpp"
#include "terrain/synthesis/landscape/structures.hpp"
#include "terrain/synthesis/landscape/trees.hpp"

namespace overfly::terrain::synthesis {

struct Canvas {
  int x0 = 0;  ///< of the picture's texel (0, 0) of this block
  int y0 = 0;
  int width = 0;
  int height = 0;
  float texel_m = 0.3F;
  float half_m = 0.0F;
  std::vector<Rgb> colour;
  std::vector<float> shadow;  ///< 0 = in the sun, 1 = dark

  Canvas(int x, int y, int w, int h, float texel, float half)
      : x0(x),
        y0(y),
        width(w),
        height(h),
        texel_m(texel),
        half_m(half),
        colour(static_cast<std::size_t>(w) * h),
        shadow(static_cast<std::size_t>(w) * h, 0.0F) {}

  /// Landscape coordinates of a texel's middle.
  [[nodiscard]] float east(int u) const {
    return (static_cast<float>(x0 + u) + 0.5F) * texel_m - half_m;
  }
  [[nodiscard]] float north(int v) const {
    return half_m - (static_cast<float>(y0 + v) + 0.5F) * texel_m;
  }
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * width + u;
  }

  /// Calls visit(u, v) for the block's texels within `reach_m` of a place.
  template <typename Visit>
  void around(float x, float y, float reach_m, Visit visit) {
    const float inverse = 1.0F / texel_m;
    const int left = floor_int((x - reach_m + half_m) * inverse) - x0;
    const int right = floor_int((x + reach_m + half_m) * inverse) - x0;
    const int top = floor_int((half_m - y - reach_m) * inverse) - y0;
    const int bottom = floor_int((half_m - y + reach_m) * inverse) - y0;
    for (int v = std::max(0, top); v <= std::min(height - 1, bottom); ++v) {
      for (int u = std::max(0, left); u <= std::min(width - 1, right); ++u) visit(u, v);
    }
  }
};

/// Darkens the texels in the shadow of trees and structures.
void cast_shadow(Canvas& canvas, const Tree& tree);
void cast_shadow(Canvas& canvas, const Structure& structure);
void draw(Canvas& canvas, const Tree& tree);
void draw(Canvas& canvas, const Structure& structure);

}  // namespace overfly::terrain::synthesis
