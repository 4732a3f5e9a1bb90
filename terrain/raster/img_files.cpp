#include "terrain/raster/img_files.hpp"

#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal_priv.h>

#include <filesystem>
#include <string>

#include "core/text/lower_case.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

/// GDAL's own function.
GDALDataset* (*open_img)(GDALOpenInfo*) = nullptr;

/// Whether a file lies next to a raster and is named as it is, except for the extension.
bool is_part_of(const fs::path& raster, const fs::path& file) {
  const fs::path own = fs::absolute(raster).lexically_normal();
  const fs::path other = fs::absolute(file).lexically_normal();
  if (other == own) return true;
  const std::string begin = lower_case(own.stem().string()) + ".";
  return other.parent_path() == own.parent_path() &&
         lower_case(other.filename().string()).starts_with(begin);
}

/// GDAL lists a file of overviews, and the pixels of that, only once it was opened.
void open_overviews(GDALDataset& dataset) {
  for (int band = 1; band <= dataset.GetRasterCount(); ++band) {
    (void)dataset.GetRasterBand(band)->GetOverviewCount();
  }
}

GDALDataset* open_own_files_only(GDALOpenInfo* info) {
  GDALDataset* dataset = open_img(info);
  if (dataset == nullptr) return nullptr;
  open_overviews(*dataset);
  const CPLStringList files(dataset->GetFileList());
  for (int i = 0; i < files.size(); ++i) {
    if (is_part_of(info->pszFilename, files[i])) continue;
    CPLError(CE_Failure,
             CPLE_OpenFailed,
             "%.300s: consists of a file that is not next to it and named as it is: %.200s",
             info->pszFilename,
             files[i]);
    GDALClose(dataset);
    return nullptr;
  }
  return dataset;
}

}  // namespace

void restrict_img_files() {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("HFA");
  if (driver == nullptr || driver->pfnOpen == &open_own_files_only) return;
  open_img = driver->pfnOpen;
  driver->pfnOpen = &open_own_files_only;
}

}  // namespace overfly::terrain
