#include "terrain/raster/source_files.hpp"

#include <cpl_string.h>

#include <string>
#include <system_error>

#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/raster/virtual_raster.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

fs::path plain_name(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

}  // namespace

Status add_source_files(const fs::path& raster, std::set<fs::path>& files) {
  const fs::path own = plain_name(raster);
  files.insert(own);
  auto dataset = open_raster(own);
  if (!dataset) return dataset.error();
  const GdalMessages quiet;
  const CPLStringList named((*dataset)->GetFileList());
  dataset->reset();
  const bool is_virtual = is_virtual_raster(own);
  for (int i = 0; i < named.size(); ++i) {
    const fs::path other = plain_name(named[i]);
    std::error_code ignored;
    if (!fs::is_regular_file(other, ignored) || !files.insert(other).second) continue;
    // Of the files that the list names, only sources and virtual rasters have files of their own.
    // A source that is no raster is a fault of reading.
    if (is_virtual || is_virtual_raster(other)) (void)add_source_files(other, files);
  }
  for (const char* extension : {".aux.xml", ".ovr", ".msk"}) {
    files.insert(own.string() + extension);
  }
  return {};
}

}  // namespace overfly::terrain
