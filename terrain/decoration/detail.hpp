// Synthetic detail: texels finer than the imagery, for low flights.
//
// This is not the real ground. It gives an estimator texture where the imagery's texels are larger
// than the camera's pixels, with statistics that continue those of the imagery. Every run that uses
// it must record that.
#pragma once

#include <memory>
#include <string>

#include "core/result.hpp"
#include "terrain/decoration/detail_model.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::terrain {

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
