// Inside terrain only: the files from which GDAL reads a raster.
#pragma once

#include <filesystem>
#include <set>

#include "core/result.hpp"

namespace overfly::terrain {

/// Adds the absolute names of a raster, of the sources of a virtual raster's bands at any depth,
/// and of the files next to each of them: those in use (of a source: those with its name), and the
/// usual ones that GDAL would read if they appeared (.aux.xml, .ovr, .msk). Opens virtual rasters
/// only, and the raster itself. Errors: as open_raster, for the raster itself.
[[nodiscard]] Status add_source_files(const std::filesystem::path& raster,
                                      std::set<std::filesystem::path>& files);

}  // namespace overfly::terrain
