// Inside terrain only: restricts the contents of GDAL virtual rasters (VRT).
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace overfly::terrain {

/// Whether GDAL would treat a file as a virtual raster, by its first 1024 bytes.
[[nodiscard]] bool is_virtual_raster(const std::filesystem::path& file);

/// Reads the description of a virtual raster, and of the rasters it consists of, before GDAL does.
/// Of any other file it reads only the first bytes.
///
/// A description may contain only plain sources that are named relative to it and lie inside its
/// folder after symbolic links are resolved. All else that GDAL would follow is rejected: absolute
/// names, addresses, archives, parts of containers, descriptions in place of names, raw bytes,
/// warps, computed bands, unknown elements, sources with a side-car (an overview, a header) that
/// leads out of the folder, and virtual rasters as sources that are symbolic links.
/// Errors: kNotFound for a missing source; kUnreadable naming the file and the reason.
[[nodiscard]] Status check_virtual_raster(const std::filesystem::path& file);

/// Makes GDAL open only virtual rasters that check_virtual_raster accepts, whoever names them: a
/// file of overviews or a mask next to a raster of any format may be a virtual raster, too.
/// @pre GDALAllRegister() was called
void restrict_virtual_rasters();

/// While it exists, GDAL opens a virtual raster of this name on this thread without another check.
class CheckedName {
 public:
  explicit CheckedName(const std::filesystem::path& name);
  ~CheckedName();
  CheckedName(const CheckedName&) = delete;
  CheckedName& operator=(const CheckedName&) = delete;
};

}  // namespace overfly::terrain
