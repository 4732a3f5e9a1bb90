// overfly world download: public imagery and elevation of a place.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "core/motion/pose.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "terrain/download.hpp"

namespace overfly::app {
namespace {

struct DownloadArguments {
  terrain::DownloadOptions options;
  std::string center;
  std::string out;
  double size_km = 4.0;
  std::optional<double> ground_height_m;
  bool dry_run = false;
  bool list = false;
  bool quiet = false;
};

Status read_center(const std::string& text, terrain::DownloadOptions& options) {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf%c", &lat_deg, &lon_deg, &rest) != 2) {
    return Error{ErrorCode::kInvalidArgument,
                 "--center = \"" + text + "\": must be LAT,LON in degrees, as 39.35,-86.03"};
  }
  options.center_lat_rad = rad_from_deg(lat_deg);
  options.center_lon_rad = rad_from_deg(lon_deg);
  return {};
}

std::string megabytes(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f MB", static_cast<double>(bytes) / 1e6);
  return text;
}

int print_plan(const DownloadArguments& arguments) {
  const auto plan = terrain::plan_download(arguments.options);
  if (!plan) return report(plan.error());
  std::uint64_t transfer_bytes = 0;
  std::uint64_t disk_bytes = 0;
  for (const terrain::DownloadPlan::Layer& layer : plan->layers) {
    std::cout << layer.what << ": " << layer.width_px << " x " << layer.height_px << " px of "
              << layer.pixel_m << " m in " << layer.crs << ", " << layer.requests.size()
              << (layer.requests.size() == 1 ? " request" : " requests") << ", about "
              << megabytes(layer.transfer_bytes) << "\n  from " << layer.source
              << "\n  credit: " << layer.attribution << '\n';
    transfer_bytes += layer.transfer_bytes;
    disk_bytes += layer.disk_bytes;
    if (!arguments.list) continue;
    for (const terrain::DownloadRequest& request : layer.requests) {
      std::cout << "  " << request.url << '\n';
    }
  }
  std::cout << "in total about " << megabytes(transfer_bytes) << " to fetch, up to "
            << megabytes(disk_bytes) << " of disk\n";
  for (const std::string& warning : plan->warnings) std::cout << "warning: " << warning << '\n';
  return kExitOk;
}

int download(DownloadArguments arguments) {
  const Status read = read_center(arguments.center, arguments.options);
  if (!read) return report(read.error());
  arguments.options.size_m = 1000.0 * arguments.size_km;
  arguments.options.folder = arguments.out;
  arguments.options.ground_height_m = arguments.ground_height_m;
  if (arguments.dry_run) return print_plan(arguments);
  const std::atomic<bool>& stop = catch_stop_signals();
  Result<terrain::DownloadReport> done = Error{};
  {
    ProgressDisplay display(arguments.quiet);
    done = terrain::download_world(arguments.options, [&](double share, const std::string& doing) {
      display.show(share, doing);
      return !stop.load();
    });
  }
  if (!done) return report(done.error());
  for (const std::string& warning : done->warnings) std::cerr << "warning: " << warning << '\n';
  if (!arguments.quiet) {
    std::cerr << done->fetched << " requests answered, " << done->reused << " chunks reused, "
              << done->repeated << " attempts repeated, " << done->absent << " tiles absent\n";
  }
  std::cout << done->manifest.string() << '\n';
  return kExitOk;
}

}  // namespace

void add_world_download_command(CLI::App& world, int& exit_code) {
  const auto arguments = std::make_shared<DownloadArguments>();
  terrain::DownloadOptions& options = arguments->options;
  CLI::App* command =
      world.add_subcommand("download", "Fetch public imagery and elevation of a place");
  command->add_option("--center", arguments->center, "LAT,LON in degrees")->required();
  command->add_option("--size", arguments->size_km, "Side of the square [km]")
      ->capture_default_str();
  command->add_option("--out", arguments->out, "Folder to create, or to resume in")->required();
  command->add_option("--imagery-m", options.imagery_m, "Texel size of the imagery [m]")
      ->capture_default_str();
  command->add_option("--elevation-m", options.elevation_m, "Spacing of the elevation [m]")
      ->capture_default_str();
  command
      ->add_option(
          "--elevation-margin-m", options.elevation_margin_m, "Elevation beyond the imagery [m]")
      ->capture_default_str();
  command
      ->add_option("--source",
                   options.imagery_source,
                   "usgs, or addresses with {z} {x} {y}, or a WMS with {bbox} {width} {height}")
      ->capture_default_str();
  command->add_option("--attribution", options.imagery_attribution, "Credit line of such a source");
  command->add_option("--tile-px", options.tile_px, "Side of its tiles [px]")
      ->capture_default_str();
  command->add_option("--finest-zoom", options.finest_zoom, "Finest zoom level of its tiles")
      ->capture_default_str();
  command->add_option("--elevation-source", options.elevation_source, "usgs or none")
      ->capture_default_str();
  command->add_option("--ground-height-m",
                      arguments->ground_height_m,
                      "Ground height above the ellipsoid [m], without elevation");
  command
      ->add_option("--imagery-service", options.imagery_service, "Address of the imagery service")
      ->capture_default_str();
  command
      ->add_option(
          "--elevation-service", options.elevation_service, "Address of the elevation service")
      ->capture_default_str();
  command->add_option("--parallel", options.parallel, "Simultaneous requests")
      ->capture_default_str();
  command->add_option("--chunk-px", options.chunk_px, "Side of the largest requested image [px]")
      ->capture_default_str();
  command->add_option("--attempts", options.attempts, "Attempts for one request")
      ->capture_default_str();
  command
      ->add_option("--most-requests",
                   options.most_requests,
                   "Maximum number of requests; a larger plan is refused")
      ->capture_default_str();
  command->add_flag("--keep-chunks", options.keep_chunks, "Keep the fetched files");
  command->add_flag("--dry-run", arguments->dry_run, "Print sizes without fetching images");
  command->add_flag("--list", arguments->list, "With --dry-run: print every address");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = download(*arguments); });
}

}  // namespace overfly::app
