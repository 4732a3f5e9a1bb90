#include "server/app/commands/world/world_argument.hpp"

#include <charconv>
#include <filesystem>

#include "terrain/synthesize.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;

Result<terrain::World> open_manifest(const fs::path& manifest) {
  const Result<terrain::WorldSpec> spec = terrain::read_world_manifest(manifest);
  if (!spec) return spec.error();
  return terrain::open_world(*spec);
}

Result<terrain::World> open_builtin(const std::string& text) {
  std::uint64_t seed = 1;
  if (const std::size_t colon = text.find(':'); colon != std::string::npos) {
    const std::string digits = text.substr(colon + 1);
    const char* end = digits.data() + digits.size();
    const auto [stopped, error] = std::from_chars(digits.data(), end, seed);
    if (error != std::errc() || stopped != end) {
      return Error{ErrorCode::kInvalidArgument,
                   "--world " + text + ": the seed must be a whole number"};
    }
  }
  const Result<fs::path> folder = terrain::builtin_world(seed);
  if (!folder) return folder.error();
  return open_manifest(*folder / "world.json");
}

}  // namespace

Result<terrain::World> open_world_argument(const std::string& text) {
  if (text == "builtin" || text.starts_with("builtin:")) return open_builtin(text);
  const fs::path path = text;
  std::error_code failed;
  if (fs::is_directory(path, failed)) return open_manifest(path / "world.json");
  if (path.extension() == ".json" || !fs::exists(path, failed)) return open_manifest(path);
  terrain::WorldSpec spec;
  spec.name = path.stem().string();
  terrain::ImageryLayer layer;
  layer.file = path;
  spec.imagery.push_back(layer);
  spec.ground_height_m = 0.0;
  return terrain::open_world(spec);
}

}  // namespace overfly::app
