// overfly serve: the web server with its dashboard.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "flight/mavlink/link/link_address.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/frame_cache_options.hpp"
#include "server/app/install_paths.hpp"
#include "server/app/stop_signal.hpp"
#include "server/app/token_file.hpp"
#include "server/imagery/live/live_address.hpp"
#include "server/net/http/access_token.hpp"
#include "server/net/server.hpp"
#include "server/timing/thread_priority.hpp"
#include "terrain/files/network.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;

struct ServeArguments {
  std::string address = "127.0.0.1";  ///< loopback by default
  std::uint16_t port = 8480;          ///< 0 = any free port
  std::string runs = "runs";
  std::string sweeps = "sweeps";
  std::string studies = "studies";
  std::string scenarios;
  std::string web;
  std::string token_file;
  std::string viewer_token_file;
  /// Host names and addresses that clients may use, in addition to those of AllowedHosts.
  std::vector<std::string> allowed_hosts;
  bool no_token = false;
  std::vector<std::string> data = {"worlds"};
  int parallel_runs = 1;
  std::size_t max_waiting_runs = 100;  ///< further runs are refused
  std::string uploads = "uploads";
  std::string saved_scenarios = "saved-scenarios";
  double frame_cache_gib = kFrameCacheGib;
  double upload_quota_mib = 4096.0;
  double memory_limit_mib = 0.0;
  /// Overrides may name programs to start and network addresses.
  bool allow_commands = false;
  /// Links to live vehicles that scenarios may open.
  std::vector<std::string> links;
  /// Live cameras that calibrations may open.
  std::vector<std::string> cameras;
};

void log_line(const std::string& level, const std::string& text) {
  if (level == "error") {
    spdlog::error(text);
  } else if (level == "warning") {
    spdlog::warn(text);
  } else if (level == "debug") {
    spdlog::debug(text);
  } else {
    spdlog::info(text);
  }
}

/// Names the runs that will not fly.
void warn_of_waiting_runs(const server::RunList& list) {
  std::string waiting;
  for (const auto& run : list) {
    if (run->status != server::RunStatus::kQueued) continue;
    waiting += (waiting.empty() ? "" : ", ") + run->id + " (" + run->scenario + ")";
  }
  if (!waiting.empty()) spdlog::warn("these runs waited and will not fly: {}", waiting);
}

Result<std::string> token_from(const std::string& file) {
  auto read = open_token_file(file);
  if (!read) return read.error();
  if (!read->warning.empty()) spdlog::warn(read->warning);
  return std::move(read->token);
}

/// Sets the tokens that clients must send; none with --no-token.
Status set_tokens(const ServeArguments& arguments, net::ServerOptions* options) {
  if (arguments.no_token) return {};
  auto token = arguments.token_file.empty() ? net::make_token() : token_from(arguments.token_file);
  if (!token) return token.error();
  options->token = std::move(*token);
  if (arguments.viewer_token_file.empty()) return {};
  auto viewer_token = token_from(arguments.viewer_token_file);
  if (!viewer_token) return viewer_token.error();
  options->viewer_token = std::move(*viewer_token);
  return {};
}

int serve(const ServeArguments& arguments) {
  (void)catch_stop_signals();
  terrain::turn_network_off();
  server::draw_on_the_asking_thread();
  spdlog::set_default_logger(spdlog::stderr_color_mt("overfly"));
  net::ServerOptions options;
  if (const Status status = set_tokens(arguments, &options); !status) return report(status.error());
  server::RunManagerOptions manager_options;
  manager_options.runs_folder = arguments.runs;
  manager_options.sweeps_folder = arguments.sweeps;
  manager_options.studies_folder = arguments.studies;
  manager_options.scenarios_folder =
      arguments.scenarios.empty() ? scenarios_folder() : fs::path(arguments.scenarios);
  manager_options.saved_scenarios_folder = arguments.saved_scenarios;
  manager_options.max_parallel_runs = arguments.parallel_runs;
  manager_options.max_waiting_runs = arguments.max_waiting_runs;
  manager_options.memory_limit_bytes =
      static_cast<std::uint64_t>(arguments.memory_limit_mib * 1024.0 * 1024.0);
  manager_options.allow_commands = arguments.allow_commands;
  for (const std::string& text : arguments.links) {
    const auto link = flight::mavlink::parse_link_address(text, "--allow-link");
    if (!link) return report(link.error());
    manager_options.allowed_links.push_back(link->text());
  }
  manager_options.data_folders.emplace(arguments.data.begin(), arguments.data.end());
  manager_options.data_folders->emplace_back(arguments.uploads);
  manager_options.log = log_line;
  const auto runs = server::RunManager::create(manager_options);
  if (!runs) return report(runs.error());
  server::ViewService views(**runs);

  for (const std::string& text : arguments.cameras) {
    auto camera = server::parse_live_address(text, "--allow-camera");
    if (!camera) return report(camera.error());
    options.cameras.push_back(std::move(*camera));
  }
  options.address = arguments.address;
  options.port = arguments.port;
  options.allowed_hosts = arguments.allowed_hosts;
  options.web_folder = arguments.web.empty() ? web_folder() : fs::path(arguments.web);
  options.frame_cache_gib = arguments.frame_cache_gib;
  options.uploads_folder = arguments.uploads;
  options.limits.uploads.quota_bytes =
      static_cast<std::uint64_t>(arguments.upload_quota_mib * 1024.0 * 1024.0);
  options.log = log_line;
  const auto server = net::Server::start(options, **runs, views);
  if (!server) return report(server.error());
  if (options.web_folder.empty()) {
    spdlog::warn("the dashboard is not built (web/dist): only REST and WebSocket are served");
  }
  std::cout << "Overfly is at " << (*server)->url() << std::endl;
  if (const std::string url = (*server)->viewer_url(); !url.empty()) {
    std::cout << "For looking only: " << url << std::endl;
  }
  wait_for_stop_signal();
  // First of all: the farewell to viewers and the ends of sweeps and studies take their time.
  (*runs)->cancel_all();
  spdlog::info("stopping: running flights are cancelled; their folders stay readable");
  warn_of_waiting_runs((*runs)->runs());
  return kExitOk;
}

}  // namespace

void add_serve_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ServeArguments>();
  CLI::App* command = app.add_subcommand("serve", "Serve the dashboard and the REST interface");
  command->add_option("--address", arguments->address, "Address to listen on")
      ->capture_default_str();
  command->add_option("--port", arguments->port, "Port; 0 = any free one")->capture_default_str();
  command->add_option("--runs", arguments->runs, "Folder of the runs")->capture_default_str();
  command
      ->add_option("--sweeps",
                   arguments->sweeps,
                   "Folder of the sweeps, which need not exist; an empty name = none are shown")
      ->capture_default_str();
  command
      ->add_option(
          "--frame-cache-gib",
          arguments->frame_cache_gib,
          "Size at most of the rendered pictures that the sweeps share, in .frame_cache of "
          "their folder [GiB]; 0: every picture is rendered")
      ->check(CLI::Range(0.0, kMostFrameCacheGib))
      ->capture_default_str();
  command
      ->add_option("--studies",
                   arguments->studies,
                   "Folder of the studies that clients start, made with the first one; an empty "
                   "name = they cannot")
      ->capture_default_str();
  command->add_option("--scenarios", arguments->scenarios, "Folder of the scenario files");
  command
      ->add_option("--saved-scenarios",
                   arguments->saved_scenarios,
                   "Folder of the scenarios that clients save; an empty name = they cannot")
      ->capture_default_str();
  command
      ->add_option(
          "--data",
          arguments->data,
          "Folder whose files scenarios may name (repeatable), in addition to the folder of "
          "the scenario files and the folders `data` in them")
      ->allow_extra_args(false)
      ->capture_default_str();
  command->add_option("--uploads", arguments->uploads, "Folder of uploaded flight logs")
      ->capture_default_str();
  command
      ->add_option("--upload-quota",
                   arguments->upload_quota_mib,
                   "MiB that uploaded flight logs may take together; 0 = no uploads")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  command->add_option("--web", arguments->web, "Folder of the built dashboard");
  CLI::Option* token_file = command->add_option(
      "--token-file",
      arguments->token_file,
      "File with the token that clients must show, one line; created if absent");
  CLI::Option* viewer_token_file = command->add_option(
      "--viewer-token-file",
      arguments->viewer_token_file,
      "File with the token of viewers, who may look at everything and change nothing; created if "
      "absent");
  command
      ->add_flag("--no-token", arguments->no_token, "Require no token; only on a loopback address")
      ->excludes(token_file)
      ->excludes(viewer_token_file);
  command
      ->add_option("--allow-host",
                   arguments->allowed_hosts,
                   "Additional host name or address that clients may use; repeatable")
      ->allow_extra_args(false);
  command->add_option("--parallel-runs", arguments->parallel_runs, "Flights at the same time")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command
      ->add_option(
          "--waiting-runs", arguments->max_waiting_runs, "Flights that may wait in the queue")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command
      ->add_option("--memory-limit",
                   arguments->memory_limit_mib,
                   "MiB that flights and pictures may use; four fifths of the machine's memory by "
                   "default")
      ->check(CLI::Range(256.0, 1e9));
  command->add_flag(
      "--allow-commands",
      arguments->allow_commands,
      "Let clients, not only scenario files, set programs and addresses of estimators");
  command->add_option("--allow-link",
                      arguments->links,
                      "Link to a live vehicle that scenarios may open, e.g. "
                      "udp-listen:127.0.0.1:14550; repeatable");
  command
      ->add_option("--allow-camera",
                   arguments->cameras,
                   "Live camera that calibrations may open, e.g. rtsp://192.168.1.10/stream; "
                   "repeatable")
      ->allow_extra_args(false);
  command->callback([arguments, &exit_code] { exit_code = serve(*arguments); });
}

}  // namespace overfly::app
