// Inside terrain only: what a GDAL virtual raster (VRT) may be made of.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace overfly::terrain {

/// Reads a virtual raster's description before GDAL does, and those of the rasters that it is made
/// of; of any other file it reads the first bytes alone.
///
/// A description may be made of plain sources, named relative to it, inside its folder after links
/// are resolved. All else that GDAL would follow is refused: absolute names, addresses, archives,
/// parts of containers, descriptions in place of names, raw bytes, warps, computed bands,
/// elements that are not known here, and sources with a file beside them (an overview, a header)
/// that leads out of the folder.
/// Errors: kNotFound for a source that is not there; kUnreadable naming the file and what is wrong.
[[nodiscard]] Status check_virtual_raster(const std::filesystem::path& file);

}  // namespace overfly::terrain
