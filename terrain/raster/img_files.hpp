// Inside terrain only: restricts the files of which an ERDAS raster (.img) consists.
#pragma once

namespace overfly::terrain {

/// Makes GDAL open only ERDAS rasters whose other files (.ige: the pixels of a large raster, .rrd:
/// its overviews) lie next to them and are named as they are, whoever names the raster. Inside, it
/// may name any file. Files next to a raster are checked by SideCars.
/// @pre GDALAllRegister() was called
void restrict_img_files();

}  // namespace overfly::terrain
