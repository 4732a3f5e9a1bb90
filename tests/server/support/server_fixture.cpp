#include "tests/server/support/server_fixture.hpp"

#include <algorithm>
#include <stdexcept>

#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "terrain/synthesize.hpp"

namespace overfly::server::testing {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path& small_world() {
  static const overfly::testing::TemporaryFolder folder;
  static const fs::path manifest = [] {
    terrain::SynthesisOptions options;
    options.size_m = 600.0;
    options.texel_m = 2.0;
    const Status made = terrain::synthesize_world(folder.path() / "world", options);
    if (!made) throw std::runtime_error(made.error().message);
    return folder.path() / "world" / "world.json";
  }();
  return manifest;
}

Json small_document() {
  return {{"format_version", 1},
          {"name", "small"},
          {"world", {{"manifest", small_world().string()}}},
          {"flight", {{"course", {{"length_m", 800}, {"leg_length_m", 300}}}}},
          {"duration_s", 2},
          {"camera", {{"width_px", 160}, {"height_px", 120}, {"rate_hz", 10}}}};
}

Scenario small_scenario(const std::vector<std::string>& overrides) {
  std::vector<Override> changes;
  for (const std::string& text : overrides) changes.push_back(parse_override(text).value());
  Result<Scenario> scenario = resolve_scenario(small_document(), changes, "/");
  if (!scenario) throw std::runtime_error(scenario.error().message);
  return *scenario;
}

RendererFactory noop_factory() {
  return [](std::shared_ptr<const terrain::TileSource> tiles) {
    return Result<std::unique_ptr<renderer::Renderer>>(
        renderer::create_noop_renderer(std::move(tiles)));
  };
}

RunOptions options_for(const fs::path& folder) {
  RunOptions options;
  options.folder = folder;
  options.renderer_factory = noop_factory();
  return options;
}

std::vector<std::pair<std::string, std::string>> contents_without_timings(const fs::path& folder) {
  std::vector<std::pair<std::string, std::string>> contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path name = entry.path().filename();
    if (!entry.is_regular_file() || name == "timings.json" || name == "created.json") continue;
    contents.emplace_back(fs::relative(entry.path(), folder).string(),
                          overfly::testing::read_text(entry.path()));
  }
  std::sort(contents.begin(), contents.end());
  return contents;
}

}  // namespace overfly::server::testing
