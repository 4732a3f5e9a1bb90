#include "terrain/raster/installation.hpp"

#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "terrain/raster/gdal_dataset.hpp"

namespace overfly::terrain {

Installation probe_installation() {
  initialise_gdal();
  Installation installation;
  installation.gdal_version = GDALVersionInfo("RELEASE_NAME");
  for (const char* name : {"GTiff", "JPEG", "PNG", "VRT", "MEM", "USGSDEM", "SRTMHGT"}) {
    if (GDALGetDriverByName(name) == nullptr) installation.missing_drivers.emplace_back(name);
  }
  if (GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff"); driver != nullptr) {
    const char* options = driver->GetMetadataItem(GDAL_DMD_CREATIONOPTIONLIST);
    installation.geotiff_jpeg =
        options != nullptr && std::string(options).find("<Value>JPEG</Value>") != std::string::npos;
  }
  CPLPushErrorHandler(CPLQuietErrorHandler);
  OGRSpatialReference utm;
  installation.projection_database = utm.importFromEPSG(32616) == OGRERR_NONE;
  CPLPopErrorHandler();
  return installation;
}

}  // namespace overfly::terrain
