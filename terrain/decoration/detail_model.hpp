// Parameters of synthetic detail, and the statistics of the imagery that it uses.
#pragma once

#include <cstdint>

#include "core/result.hpp"

namespace overfly::terrain {

struct DetailOptions {
  int octaves = 2;  ///< each halves the texel size, in [1, 4]
  /// Amplitude relative to the continued spectrum of the imagery, in [0, 2].
  double strength = 1.0;
  std::uint64_t seed = 1;  ///< another seed gives other detail

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;
};

/// Statistics of the imagery's finest bands: wavelet details of luma, see `with_detail`.
struct DetailStatistics {
  /// Mean squares of the details of blocks of 2 x 2 texels [grey levels^2]: across (east-west),
  /// down, diagonal.
  double band_energy[3] = {0.0, 0.0, 0.0};
  /// Ratio of a band's amplitude to that of the band one octave coarser, over the finest three.
  double decay = 0.5;
  /// Root of band_energy divided by the value predicted from the local contrast.
  double contrast_gain = 1.0;
  int tiles = 0;  ///< number of measured tiles
};

}  // namespace overfly::terrain
