// Inside terrain only: what of GDAL this program leaves open to the world outside.
#pragma once

namespace overfly::terrain {

/// Leaves of GDAL's drivers those that read and write local raster files, and closes its network,
/// archive and stream file systems ("/vsicurl/", "/vsizip/", "/vsistdin/", ...) for the whole
/// program: no name in a scenario, a manifest or a data file can make GDAL call out or unpack.
/// @pre GDALAllRegister() was called
void close_outside_access();

}  // namespace overfly::terrain
