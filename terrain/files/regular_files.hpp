// Inside terrain only: restricts GDAL to regular files.
#pragma once

namespace overfly::terrain {

/// Hides everything except regular files and folders from GDAL, for the whole program: a FIFO, a
/// socket or a device appears as absent. GDAL would otherwise also open side-cars of any kind by
/// itself, and opening a FIFO blocks until there is a writer.
void show_regular_files_alone();

}  // namespace overfly::terrain
