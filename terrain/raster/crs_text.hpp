// Validates coordinate reference systems given as text in scenarios, manifests and virtual rasters.
#pragma once

#include <string>

#include "core/result.hpp"

namespace overfly::terrain {

/// Accepts the code of an authority ("EPSG:32616", "EPSG:26916+5703"), WKT, or a PROJ text that
/// names no file or address; grids only by bare names, which PROJ looks up among its own. GDAL
/// itself would open files and fetch addresses named in a text.
/// @param field  name of the field, as "imagery.0.crs"
/// Errors: kInvalidArgument.
[[nodiscard]] Status check_crs_text(const std::string& text, const std::string& field);

}  // namespace overfly::terrain
