// Inside download only: merges chunks into one file.
#pragma once

#include <functional>

#include "terrain/download/chunk.hpp"

namespace overfly::terrain::download {

/// Statistics of the merged pixels.
struct MergeReport {
  double void_share = 0.0;  ///< of the layer's pixels
  int uniform_chunks = 0;   ///< of one colour throughout: the service has no imagery there
};

/// Writes a tiled, losslessly compressed GeoTIFF with area-averaged overviews. Missing chunks,
/// pixels outside a chunk's mask and invalid heights become void. Written to a temporary name and
/// renamed, so that it appears whole or not at all.
/// @param go_on  called with the share done; returning false cancels
/// Errors: kIo, kCancelled.
[[nodiscard]] Result<MergeReport> merge_chunks(const ChunkLayer& layer,
                                               const std::filesystem::path& file,
                                               const std::function<bool(double)>& go_on);

}  // namespace overfly::terrain::download
