// Inside download only: chunks become one file.
#pragma once

#include <functional>

#include "terrain/download/chunk.hpp"

namespace overfly::terrain::download {

/// What the pixels say once they are together.
struct MergeReport {
  double void_share = 0.0;  ///< of the layer's pixels
  int uniform_chunks = 0;   ///< of one colour throughout: places a service has no imagery of
};

/// Writes a tiled, losslessly compressed GeoTIFF with area-averaged overviews; chunks that are not
/// there, pixels outside a chunk's mask and heights that are none become void.
/// Complete or not at all: written beside its name and renamed.
/// @param go_on  called with the done share; false cancels
/// Errors: kIo, kCancelled.
[[nodiscard]] Result<MergeReport> merge_chunks(const ChunkLayer& layer,
                                               const std::filesystem::path& file,
                                               const std::function<bool(double)>& go_on);

}  // namespace overfly::terrain::download
