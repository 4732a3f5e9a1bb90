#include "terrain/world/world_files.hpp"

#include <set>

#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
namespace {

/// Side-cars that GDAL looks for next to a raster.
constexpr const char* kSideCars[] = {".aux.xml", ".ovr", ".msk"};

fs::path absolute_name(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

void collect_files(const fs::path& file, std::set<fs::path>& files, int depth) {
  constexpr int kDeepest = 8;
  if (depth > kDeepest || !files.insert(absolute_name(file)).second) return;
  for (const char* extension : kSideCars) {
    files.insert(absolute_name(file.string() + extension));
  }
  const auto dataset = open_raster(file);
  if (!dataset) return;
  const GdalMessages quiet;
  const CPLStringList named((*dataset)->GetFileList());
  for (int i = 0; i < named.size(); ++i) {
    const fs::path other = absolute_name(named[i]);
    std::error_code ignored;
    if (!fs::is_regular_file(other, ignored)) continue;
    if (other.extension() == ".vrt") {
      collect_files(other, files, depth + 1);
    } else {
      files.insert(other);
    }
  }
}

}  // namespace

std::vector<WorldFile> world_files(const WorldSpec& spec) {
  std::set<fs::path> names;
  for (const ImageryLayer& layer : spec.imagery) collect_files(layer.file, names, 0);
  for (const ElevationLayer& layer : spec.elevation) collect_files(layer.file, names, 0);
  std::vector<WorldFile> files;
  files.reserve(names.size());
  for (const fs::path& name : names) files.push_back({name, file_identity(name)});
  return files;
}

std::optional<fs::path> changed_file(const std::vector<WorldFile>& files) {
  for (const WorldFile& known : files) {
    if (file_identity(known.file) != known.identity) return known.file;
  }
  return std::nullopt;
}

std::optional<fs::path> lost_file(const std::vector<WorldFile>& files) {
  for (const WorldFile& known : files) {
    if (known.identity && file_identity(known.file) != known.identity) return known.file;
  }
  return std::nullopt;
}

}  // namespace overfly::terrain
