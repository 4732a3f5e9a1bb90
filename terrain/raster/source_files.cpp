#include "terrain/raster/source_files.hpp"

#include <cpl_string.h>

#include <string>
#include <system_error>

#include "terrain/files/side_cars.hpp"
#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/raster/virtual_raster.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

using Files = std::set<fs::path>;

fs::path plain_name(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

bool is_regular(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored);
}

/// A raster's own name, and those of files that GDAL would read if they appeared.
void add_with_candidates(const fs::path& raster, Files& files) {
  files.insert(raster);
  for (const char* extension : {".aux.xml", ".ovr", ".msk"}) {
    files.insert(raster.string() + extension);
  }
}

Status add_files_of(const fs::path& raster, SideCars& side_cars, Files& files) {
  add_with_candidates(raster, files);
  auto dataset = open_raster(raster);
  if (!dataset) return dataset.error();
  const GdalMessages quiet;
  const CPLStringList named((*dataset)->GetFileList());
  dataset->reset();
  const bool is_virtual = is_virtual_raster(raster);
  for (int i = 0; i < named.size(); ++i) {
    const fs::path other = plain_name(named[i]);
    if (!is_regular(other) || files.contains(other)) continue;
    if (is_virtual_raster(other)) {
      // A source that is no raster is a fault of reading.
      (void)add_files_of(other, side_cars, files);
    } else if (is_virtual) {
      // A mosaic may have thousands of sources: they are not opened for their list of files.
      add_with_candidates(other, files);
      for (const fs::path& beside : side_cars.of(other)) {
        if (is_regular(beside)) files.insert(beside);
      }
    } else {
      files.insert(other);
    }
  }
  return {};
}

}  // namespace

Status add_source_files(const fs::path& raster, Files& files) {
  SideCars side_cars;
  return add_files_of(plain_name(raster), side_cars, files);
}

}  // namespace overfly::terrain
