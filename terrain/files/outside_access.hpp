// Inside terrain only: restricts GDAL's access to the outside.
#pragma once

namespace overfly::terrain {

/// Keeps only GDAL's drivers for local raster files, and disables its network, archive and stream
/// file systems ("/vsicurl/", "/vsizip/", "/vsistdin/", ...) for the whole program. A name in a
/// scenario, a manifest or a data file thus cannot make GDAL access the network or unpack archives.
/// @pre GDALAllRegister() was called
void close_outside_access();

}  // namespace overfly::terrain
