// Inside terrain only: GDAL's view of this machine's files.
#pragma once

namespace overfly::terrain {

/// Shows GDAL regular files and folders alone, for the whole program: a FIFO, a socket or a device
/// is not there, whatever name leads to it. What GDAL looks for by itself, as the files beside a
/// raster, is otherwise opened whatever it is, and a FIFO waits for a writer.
void show_regular_files_alone();

}  // namespace overfly::terrain
