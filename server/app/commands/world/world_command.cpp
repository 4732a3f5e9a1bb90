// overfly world: describes worlds and makes the built-in one.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "core/motion/pose.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/commands/world/world_argument.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "terrain/synthesize.hpp"
#include "terrain/synthesize_strip.hpp"

namespace overfly::app {
namespace {

struct SynthesizeArguments {
  std::string out;
  terrain::SynthesisOptions options;
  double center_lat_deg = 0.0;
  double center_lon_deg = 0.0;
  bool quiet = false;
};

struct StripArguments {
  std::string out;
  terrain::StripOptions options;
  bool quiet = false;
};

int info(const std::string& world_text) {
  const Result<terrain::World> world = open_world_argument(world_text);
  if (!world) return report(world.error());
  std::cout << terrain::describe(*world);
  return kExitOk;
}

int synthesize(SynthesizeArguments arguments) {
  const std::atomic<bool>& stop = catch_stop_signals();
  arguments.options.center_lat_rad = rad_from_deg(arguments.center_lat_deg);
  arguments.options.center_lon_rad = rad_from_deg(arguments.center_lon_deg);
  Status status;
  {
    ProgressDisplay display(arguments.quiet);
    status = terrain::synthesize_world(arguments.out, arguments.options, [&](double share) {
      display.show(share, "landscape of seed " + std::to_string(arguments.options.seed));
      return !stop.load();
    });
  }
  if (!status) return report(status.error());
  std::cout << arguments.out << "/world.json\n";
  return kExitOk;
}

int synthesize_strip(const StripArguments& arguments) {
  const std::atomic<bool>& stop = catch_stop_signals();
  Status status;
  {
    ProgressDisplay display(arguments.quiet);
    status = terrain::synthesize_strip(arguments.out, arguments.options, [&](double share) {
      display.show(share, "strip of seed " + std::to_string(arguments.options.seed));
      return !stop.load();
    });
  }
  if (!status) return report(status.error());
  std::cout << arguments.out << "/world.json\n";
  return kExitOk;
}

void add_synthesize_strip(CLI::App& world, int& exit_code) {
  const auto arguments = std::make_shared<StripArguments>();
  terrain::StripOptions& options = arguments->options;
  CLI::App* command =
      world.add_subcommand("synthesize-strip", "Make a long strip of land for endurance flights");
  command->add_option("--out", arguments->out, "Folder to create")->required();
  command->add_option("--seed", options.seed, "Seed of the landscape")->capture_default_str();
  command->add_option("--length-m", options.length_m, "Length from west to east")
      ->capture_default_str();
  command->add_option("--width-m", options.width_m, "Width from south to north")
      ->capture_default_str();
  command->add_option("--texel-m", options.texel_m, "Imagery resolution")->capture_default_str();
  command->add_option("--post-m", options.post_m, "Spacing of the elevation")
      ->capture_default_str();
  command->add_option("--relief-m", options.relief_m, "Height between valley and hilltop")
      ->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = synthesize_strip(*arguments); });
}

void add_synthesize(CLI::App& world, int& exit_code) {
  const auto arguments = std::make_shared<SynthesizeArguments>();
  terrain::SynthesisOptions& options = arguments->options;
  CLI::App* command = world.add_subcommand("synthesize", "Make an airfield landscape (GeoTIFFs)");
  command->add_option("--out", arguments->out, "Folder to create")->required();
  command->add_option("--seed", options.seed, "Seed of the landscape")->capture_default_str();
  command->add_option("--size-m", options.size_m, "Side of the square")->capture_default_str();
  command->add_option("--texel-m", options.texel_m, "Imagery resolution")->capture_default_str();
  command->add_option("--relief-m", options.relief_m, "Height between valley and hilltop")
      ->capture_default_str();
  command->add_option("--center-lat", arguments->center_lat_deg, "Latitude [deg]");
  command->add_option("--center-lon", arguments->center_lon_deg, "Longitude [deg]");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = synthesize(*arguments); });
}

}  // namespace

void add_world_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("world", "Describe and make worlds");
  command->require_subcommand(1);
  const auto world = std::make_shared<std::string>();
  CLI::App* infos = command->add_subcommand("info", "Extent, resolution, layers, warnings");
  infos->add_option("world", *world, kWorldHelp)->required();
  infos->callback([world, &exit_code] { exit_code = info(*world); });
  add_world_build_command(*command, exit_code);
  add_world_download_command(*command, exit_code);
  add_synthesize(*command, exit_code);
  add_synthesize_strip(*command, exit_code);
}

}  // namespace overfly::app
