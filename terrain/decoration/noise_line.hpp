// Noise along a line of places, several at a time.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace overfly::terrain::synthesis {

/// noise() of one seed for many places with the same y, with the same bits. Every lattice point is
/// hashed once for all places between it and its neighbours, and for all lines in a row.
class NoiseLine {
 public:
  /// @param x_min, x_max  limits of the places; x_max - x_min + 3 numbers of memory
  NoiseLine(float x_min, float x_max, std::uint32_t seed);

  /// Sets out[k] to noise(x[k], y, seed).
  /// @param x    from x_min to x_max, as many as `out`
  void sample(std::span<const float> x, float y, std::span<float> out);

 private:
  /// Hashes of one line of lattice points, each in [0, 1).
  struct LatticeLine {
    int j = std::numeric_limits<int>::min();
    std::vector<float> units;
  };

  void hash_line(LatticeLine& line, int j) const;

  int first_;  ///< lattice point of the first number
  std::uint32_t seed_;
  LatticeLine lower_;  ///< at floor(y)
  LatticeLine upper_;  ///< at floor(y) + 1
};

}  // namespace overfly::terrain::synthesis
