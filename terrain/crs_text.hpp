// Coordinate reference systems as texts from outside: scenarios, manifests, virtual rasters.
#pragma once

#include <string>

#include "core/result.hpp"

namespace overfly::terrain {

/// Whether a text is the code of an authority ("EPSG:32616", "EPSG:26916+5703"), WKT or a PROJ
/// text, and names no file or address: grids only by their bare names, which PROJ looks for among
/// its own. GDAL itself would open files and fetch addresses that a text names.
/// @param field  that holds it, as "imagery.0.crs"
/// Errors: kInvalidArgument.
[[nodiscard]] Status check_crs_text(const std::string& text, const std::string& field);

}  // namespace overfly::terrain
