#include "server/worlds/scenario_world.hpp"

#include <system_error>
#include <utility>

#include "server/scenario/document/scenario_light.hpp"
#include "terrain/files/file_digest.hpp"
#include "terrain/synthesize.hpp"

namespace overfly::server {
namespace {

using Cancelled = std::function<bool()>;

/// Checked before any file is accessed: a server must not reveal anything about other files.
Status check_confined(const terrain::WorldSpec& spec, const std::string& prefix) {
  return spec.sources.confined() ? terrain::check_world_sources(spec, prefix) : Status{};
}

/// The digests belong to the data in use only if no file was written meanwhile.
Result<OpenedWorld> open_layers(const terrain::WorldSpec& spec,
                                std::vector<terrain::WorldFile> files,
                                const Cancelled& cancelled) {
  Result<terrain::World> world = terrain::open_world(spec, cancelled);
  if (!world) return world.error();
  if (const auto changed = terrain::lost_file(files)) {
    return Error{ErrorCode::kIo, changed->string() + ": changed while it was being opened"};
  }
  return OpenedWorld{std::move(*world), {}, std::move(files)};
}

Result<OpenedWorld> open_manifest(const std::filesystem::path& manifest,
                                  const SourcePolicy& sources,
                                  const Cancelled& cancelled) {
  const terrain::WorldFile file{std::filesystem::absolute(manifest),
                                terrain::file_identity(manifest)};
  const Result<terrain::WorldSpec> spec = terrain::read_world_manifest(manifest, sources);
  if (!spec) return spec.error();
  if (Status status = check_confined(*spec, ""); !status) return status.error();
  Result<std::string> digest = terrain::file_digest(manifest);
  if (!digest) return digest.error();
  std::vector<terrain::WorldFile> files = terrain::world_files(*spec);
  files.push_back(file);
  Result<OpenedWorld> opened = open_layers(*spec, std::move(files), cancelled);
  if (opened) opened->manifest = OpenedWorld::Manifest{manifest.string(), std::move(*digest)};
  return opened;
}

Result<OpenedWorld> open_bare(const Scenario& scenario,
                              const std::function<bool(double)>& progress) {
  const Cancelled cancelled = [&] { return progress && !progress(0.0); };
  if (const auto* builtin = std::get_if<Scenario::BuiltinWorld>(&scenario.world)) {
    const Result<std::filesystem::path> folder = terrain::builtin_world(builtin->seed, progress);
    if (!folder) return folder.error();
    return open_manifest(*folder / "world.json", {}, cancelled);  // made by this program
  }
  if (const auto* manifest = std::get_if<std::filesystem::path>(&scenario.world)) {
    return open_manifest(*manifest, scenario.sources, cancelled);
  }
  terrain::WorldSpec spec = std::get<terrain::WorldSpec>(scenario.world);
  spec.sources = scenario.sources;
  if (Status status = check_confined(spec, "world."); !status) return status.error();
  return open_layers(spec, terrain::world_files(spec), cancelled);
}

}  // namespace

Result<OpenedWorld> open_scenario_world(const Scenario& scenario,
                                        const std::function<bool(double)>& progress) {
  Result<OpenedWorld> opened = open_bare(scenario, progress);
  if (!opened) return opened;
  if (Status status = dress_world(scenario, opened->world); !status) return status.error();
  return opened;
}

std::vector<terrain::WorldFile> scenario_world_files(const Scenario& scenario) {
  terrain::WorldSpec spec;
  const auto* const manifest = std::get_if<std::filesystem::path>(&scenario.world);
  if (manifest != nullptr) {
    Result<terrain::WorldSpec> read = terrain::read_world_manifest(*manifest, scenario.sources);
    if (!read) return {};
    spec = std::move(*read);
  } else if (const auto* layers = std::get_if<terrain::WorldSpec>(&scenario.world)) {
    spec = *layers;
    spec.sources = scenario.sources;
  }
  if (!check_confined(spec, "")) return {};
  std::vector<terrain::WorldFile> files = terrain::world_files(spec);
  if (manifest != nullptr) files.push_back({*manifest, terrain::file_identity(*manifest)});
  return files;
}

bool world_must_be_made(const Scenario& scenario) {
  const auto* builtin = std::get_if<Scenario::BuiltinWorld>(&scenario.world);
  std::error_code ignored;
  return builtin != nullptr &&
         !std::filesystem::exists(terrain::builtin_world_folder(builtin->seed) / "world.json",
                                  ignored);
}

std::string world_key(const Scenario& scenario) {
  std::string key = scenario.resolved.value("data", "");
  for (const char* field : {"world", "light", "detail"}) {
    key += '|';
    key += scenario.resolved.value(field, nlohmann::json::object()).dump();
  }
  return key;
}

}  // namespace overfly::server
