#include "terrain/world/world_files.hpp"

#include <set>

#include "terrain/raster/source_files.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {
namespace fs = std::filesystem;
std::vector<WorldFile> world_files(const WorldSpec& spec) {
  std::set<fs::path> names;
  // Opening the world reports the errors.
  for (const ImageryLayer& layer : spec.imagery) (void)add_source_files(layer.file, names);
  for (const ElevationLayer& layer : spec.elevation) (void)add_source_files(layer.file, names);
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
