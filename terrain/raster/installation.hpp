// Checks whether the terrain libraries on this machine are complete (for `overfly doctor`).
#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::terrain {

struct Installation {
  std::string gdal_version;                  ///< "3.6.2"
  std::vector<std::string> missing_drivers;  ///< of the required ones
  bool geotiff_jpeg = true;                  ///< JPEG-compressed GeoTIFFs can be read
  bool projection_database = true;           ///< PROJ finds its proj.db
};

[[nodiscard]] Installation probe_installation();

}  // namespace overfly::terrain
