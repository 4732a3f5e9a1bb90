// Synthetic detail: texels finer than the imagery, for low flights.
//
// This is not the real ground. It gives an estimator texture where the imagery's texels are larger
// than the camera's pixels, with statistics that continue those of the imagery. Every run that uses
// it must record that.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::terrain {

struct DetailOptions {
  int octaves = 2;  ///< each halves the texel, in [1, 4]
  /// Amplitude relative to the continued spectrum of the imagery, in [0, 2]
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
  /// Exponent of the power spectrum per area that corresponds to `decay`: power ~ frequency^slope.
  [[nodiscard]] double spectrum_slope() const;
};

/// Measures up to 16 tiles spread over the imagery. Errors: kIo as TileSource::tile.
[[nodiscard]] Result<DetailStatistics> measure_detail(const TileSource& tiles);

/// The same tiles with `octaves` finer levels below: level n of the result is level n - octaves of
/// `tiles`, texel for texel, and the finer levels average to it within 1 grey level. The local
/// amplitude follows the local contrast of the imagery; the decay from octave to octave is that of
/// the whole imagery. real_texel_m() stays that of the imagery.
///
/// Method: one step of the inverse biorthogonal wavelet transform CDF(1,3) per octave (Cohen,
/// Daubechies, Feauveau 1992, doi:10.1002/cpa.3160450502). Its low pass keeps the mean of every
/// block. Its details are drawn from a Laplace distribution, as those of photographs are
/// distributed (Mallat 1989, doi:10.1109/34.192463, sec. IV), scaled by the mean of their absolute
/// values nearby. Deterministic: a texel depends on its place, the imagery around it and the seed.
/// Thread-safe.
/// Errors: kInvalidArgument as `validate`; kIo if the imagery cannot be read.
[[nodiscard]] Result<std::shared_ptr<const TileSource>> with_detail(
    std::shared_ptr<const TileSource> tiles, const DetailOptions& options);

/// One line for people: octaves, texel sizes, seed.
[[nodiscard]] std::string describe(const DetailOptions& options);

}  // namespace overfly::terrain
