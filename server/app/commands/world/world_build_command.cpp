// overfly world build: prepares tiles and heights in a cache next to the manifest.
#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "terrain/build_world.hpp"
#include "terrain/world/world_from_files.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;

struct BuildArguments {
  std::vector<std::string> files;
  std::string out;
  std::string datum;
  std::string attribution;
  std::string name;
  std::optional<double> ground_height_m;
  bool quiet = false;
};

Result<terrain::VerticalDatum> datum_named(const std::string& name) {
  using terrain::VerticalDatum;
  if (name.empty() || name == "unknown") return VerticalDatum::kUnknown;
  if (name == "ellipsoid") return VerticalDatum::kEllipsoid;
  if (name == "egm96") return VerticalDatum::kEgm96;
  if (name == "egm2008") return VerticalDatum::kEgm2008;
  if (name == "navd88") return VerticalDatum::kNavd88;
  return Error{
      ErrorCode::kInvalidArgument,
      "--vertical-datum " + name + ": must be one of ellipsoid, egm96, egm2008, navd88, unknown"};
}

/// The manifest among the arguments; empty if they are imagery and elevation files.
fs::path manifest_of(const std::vector<std::string>& files) {
  if (files.size() != 1) return {};
  const fs::path path = files.front();
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return path / "world.json";
  return path.extension() == ".json" ? path : fs::path();
}

Result<terrain::WorldSpec> spec_of(const BuildArguments& arguments) {
  const fs::path manifest = manifest_of(arguments.files);
  if (!manifest.empty()) return terrain::read_world_manifest(manifest);
  if (arguments.out.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "--out is missing: the folder for the new world's manifest and cache"};
  }
  const std::vector<fs::path> files(arguments.files.begin(), arguments.files.end());
  auto spec = terrain::world_from_files(files);
  if (!spec) return spec;
  const auto datum = datum_named(arguments.datum);
  if (!datum) return datum.error();
  for (auto& layer : spec->elevation) layer.datum = *datum;
  for (auto& layer : spec->elevation) layer.attribution = arguments.attribution;
  for (auto& layer : spec->imagery) layer.attribution = arguments.attribution;
  spec->name =
      arguments.name.empty() ? fs::path(arguments.out).filename().string() : arguments.name;
  spec->ground_height_m = arguments.ground_height_m;
  return spec;
}

/// The world of the folder of `--out`. If it exists, it must have the same layers; what is stated
/// now replaces its name, its attribution and its ground height.
Result<terrain::WorldSpec> spec_in_folder(const BuildArguments& arguments,
                                          terrain::WorldSpec spec) {
  const fs::path manifest = fs::path(arguments.out) / "world.json";
  spec.cache_folder = terrain::cache_folder_of(manifest);
  std::error_code failed;
  if (!fs::exists(manifest, failed)) return spec;
  auto there = terrain::read_world_manifest(manifest);
  if (!there || !terrain::same_layers(*there, spec)) {
    return Error{ErrorCode::kConflict,
                 manifest.string() + ": exists and lists other layers; choose another folder"};
  }
  if (!arguments.name.empty()) there->name = arguments.name;
  if (arguments.ground_height_m) there->ground_height_m = arguments.ground_height_m;
  if (!arguments.attribution.empty()) {
    for (auto& layer : there->elevation) layer.attribution = arguments.attribution;
    for (auto& layer : there->imagery) layer.attribution = arguments.attribution;
  }
  return there;
}

/// Errors: kInvalidArgument for an option that a manifest has a field for.
Status check_options(const BuildArguments& arguments) {
  if (manifest_of(arguments.files).empty()) return {};
  const std::array<std::pair<const char*, bool>, 5> given = {
      std::pair("--out", !arguments.out.empty()),
      std::pair("--vertical-datum", !arguments.datum.empty()),
      std::pair("--attribution", !arguments.attribution.empty()),
      std::pair("--name", !arguments.name.empty()),
      std::pair("--ground-height-m", arguments.ground_height_m.has_value())};
  for (const auto& [option, is_given] : given) {
    if (!is_given) continue;
    return Error{ErrorCode::kInvalidArgument,
                 std::string(option) + ": only for imagery and elevation files; " +
                     manifest_of(arguments.files).string() + " has it as a field"};
  }
  return {};
}

/// Writes the manifest of a world that was built from files. One that is there stays as it is
/// unless something about it is stated.
Status write_manifest(const BuildArguments& arguments, const terrain::WorldSpec& spec) {
  const fs::path manifest = fs::path(arguments.out) / "world.json";
  std::error_code failed;
  const bool stated = !arguments.name.empty() || !arguments.attribution.empty() ||
                      arguments.ground_height_m.has_value();
  if (!stated && fs::exists(manifest, failed)) return {};
  fs::create_directories(arguments.out, failed);
  return terrain::write_world_manifest(manifest, spec);
}

int build(const BuildArguments& arguments) {
  if (Status status = check_options(arguments); !status) return report(status.error());
  auto spec = spec_of(arguments);
  if (spec && !arguments.out.empty()) spec = spec_in_folder(arguments, std::move(*spec));
  if (!spec) return report(spec.error());
  const std::atomic<bool>& stop = catch_stop_signals();
  Result<terrain::BuildReport> built = Error{};
  {
    ProgressDisplay display(arguments.quiet);
    built = terrain::build_world(*spec, [&](double share, const std::string& doing) {
      display.show(share, doing);
      return !stop.load();
    });
  }
  if (!built) return report(built.error());
  // Only now: a world that cannot be built leaves no manifest.
  if (!arguments.out.empty()) {
    if (Status written = write_manifest(arguments, *spec); !written) return report(written.error());
  }
  for (const std::string& warning : built->warnings) std::cerr << "warning: " << warning << "\n";
  constexpr double kMega = 1e-6;
  std::cout << built->folder.string() << ": "
            << static_cast<long>(kMega * static_cast<double>(built->bytes)) << " MB";
  if (built->was_fresh) {
    std::cout << ", up to date\n";
  } else {
    std::cout << ", " << built->chunks_made << " chunks made, " << built->chunks_kept
              << " of an earlier build kept\n";
  }
  return kExitOk;
}

}  // namespace

void add_world_build_command(CLI::App& world, int& exit_code) {
  const auto arguments = std::make_shared<BuildArguments>();
  CLI::App* command = world.add_subcommand(
      "build", "Prepare a world's tiles and heights in a cache next to its manifest");
  command->add_option("files", arguments->files, "A manifest, or imagery and elevation files")
      ->required();
  command->add_option("--out", arguments->out, "Folder for manifest and cache of a new world");
  command->add_option(
      "--vertical-datum",
      arguments->datum,
      "Vertical datum of elevation files: ellipsoid, egm96, egm2008, navd88, unknown");
  command->add_option("--attribution", arguments->attribution, "Credit line of the files");
  command->add_option(
      "--name", arguments->name, "Name of the new world; default: that of its folder");
  command->add_option("--ground-height-m",
                      arguments->ground_height_m,
                      "Ground height above the ellipsoid [m], for a world without elevation files");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = build(*arguments); });
}

}  // namespace overfly::app
