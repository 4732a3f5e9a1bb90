// Colours of the painted ground, in display grey levels.
#pragma once

#include "terrain/decoration/noise.hpp"

namespace overfly::terrain::synthesis {

struct Rgb {
  float r = 0.0F;
  float g = 0.0F;
  float b = 0.0F;
};

inline Rgb operator*(const Rgb& c, float k) { return {c.r * k, c.g * k, c.b * k}; }
inline Rgb operator+(const Rgb& a, const Rgb& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Rgb operator+(const Rgb& a, float k) { return {a.r + k, a.g + k, a.b + k}; }
inline Rgb mix(const Rgb& a, const Rgb& b, float t) {
  return {lerp(a.r, b.r, t), lerp(a.g, b.g, t), lerp(a.b, b.b, t)};
}

}  // namespace overfly::terrain::synthesis
