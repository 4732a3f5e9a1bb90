#include "terrain/decoration/noise_line.hpp"

#include <utility>

#include "terrain/decoration/noise.hpp"

namespace overfly::terrain::synthesis {
namespace {

/// What is the same for all places of a line.
struct LineOfCells {
  const float* lower;
  const float* upper;
  int first;  ///< their first lattice point
  float t;    ///< share of the upper one
};

[[gnu::always_inline]] inline void interpolate_all(const LineOfCells& cells,
                                                   std::span<const float> x,
                                                   std::span<float> out) {
  const float* from = x.data();
  float* to = out.data();
  const std::ptrdiff_t count = std::ssize(x);
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const int i = floor_int(from[k]);
    const float u = from[k] - static_cast<float>(i);
    const float s = u * u * (3.0F - 2.0F * u);
    const int at = i - cells.first;
    const float lower = lerp(cells.lower[at], cells.lower[at + 1], s);
    const float upper = lerp(cells.upper[at], cells.upper[at + 1], s);
    to[k] = 2.0F * lerp(lower, upper, cells.t) - 1.0F;
  }
}

[[gnu::always_inline]] inline void hash_all(int first,
                                            int j,
                                            std::uint32_t seed,
                                            std::span<float> units) {
  const int count = static_cast<int>(units.size());
  for (int k = 0; k < count; ++k) units[k] = unit(hash(first + k, j, seed));
}

struct Kernels {
  void (*interpolate)(const LineOfCells&, std::span<const float>, std::span<float>);
  void (*hash)(int, int, std::uint32_t, std::span<float>);
};

void interpolate_any(const LineOfCells& cells, std::span<const float> x, std::span<float> out) {
  interpolate_all(cells, x, out);
}
void hash_any(int first, int j, std::uint32_t seed, std::span<float> units) {
  hash_all(first, j, seed, units);
}

#if defined(__x86_64__)
// Without fused multiply-adds, so that both versions round alike.
__attribute__((target("avx2"))) void interpolate_avx2(const LineOfCells& cells,
                                                      std::span<const float> x,
                                                      std::span<float> out) {
  interpolate_all(cells, x, out);
}
__attribute__((target("avx2"))) void hash_avx2(int first,
                                               int j,
                                               std::uint32_t seed,
                                               std::span<float> units) {
  hash_all(first, j, seed, units);
}
#endif

const Kernels& kernels() {
#if defined(__x86_64__)
  static const Kernels chosen = __builtin_cpu_supports("avx2")
                                    ? Kernels{interpolate_avx2, hash_avx2}
                                    : Kernels{interpolate_any, hash_any};
#else
  static constexpr Kernels chosen{interpolate_any, hash_any};
#endif
  return chosen;
}

}  // namespace

NoiseLine::NoiseLine(float x_min, float x_max, std::uint32_t seed)
    : first_(floor_int(x_min)), seed_(seed) {
  const auto points = static_cast<std::size_t>(floor_int(x_max) + 2 - first_);
  lower_.units.resize(points);
  upper_.units.resize(points);
}

void NoiseLine::hash_line(LatticeLine& line, int j) const {
  if (line.j == j) return;
  kernels().hash(first_, j, seed_, line.units);
  line.j = j;
}

void NoiseLine::sample(std::span<const float> x, float y, std::span<float> out) {
  const int j = floor_int(y);
  const float v = y - static_cast<float>(j);
  if (lower_.j == j + 1 || upper_.j == j) std::swap(lower_, upper_);
  hash_line(lower_, j);
  hash_line(upper_, j + 1);
  kernels().interpolate(
      {lower_.units.data(), upper_.units.data(), first_, v * v * (3.0F - 2.0F * v)}, x, out);
}

}  // namespace overfly::terrain::synthesis
