// overfly run: flies one scenario into one folder.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/frame_cache_options.hpp"
#include "server/app/progress.hpp"
#include "server/app/score_table.hpp"
#include "server/app/stop_signal.hpp"
#include "server/record/run_folder.hpp"
#include "server/run/run.hpp"
#include "server/runs/run_memory.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "server/scoring/metrics.hpp"
#include "server/scoring/run_metrics_json.hpp"
#include "terrain/files/network.hpp"

namespace overfly::app {
namespace {

struct RunArguments {
  std::string scenario;
  std::string out;
  std::vector<std::string> sets;
  std::string renderer;
  std::vector<std::filesystem::path> folders;  ///< whose files may be named; empty = any file may
  std::vector<std::filesystem::path> closed;   ///< in them, but may not be named
  std::filesystem::path frame_cache;
  double frame_cache_gib = kFrameCacheGib;
  std::int64_t frame_cache_since_ns = 0;
  bool json = false;
  bool quiet = false;
};

Result<server::Scenario> load_to_fly(const RunArguments& arguments) {
  auto overrides = server::parse_overrides(arguments.sets);
  if (!overrides) return overrides.error();
  if (!arguments.renderer.empty()) overrides->push_back({"renderer.camera", arguments.renderer});
  const bool confined = !arguments.folders.empty();
  if (confined) terrain::turn_network_off();
  const SourcePolicy sources =
      confined ? SourcePolicy::inside(arguments.folders, arguments.closed) : SourcePolicy();
  Result<server::Scenario> scenario =
      server::load_scenario(arguments.scenario, *overrides, sources);
  if (!scenario) return scenario.error();
  scenario->sources = sources;
  if (Status status = server::check_scenario(*scenario); !status) return status.error();
  const auto memory = server::MemoryBudget::of_machine(false);
  if (Status status = memory.check(*scenario); !status) return status.error();
  return scenario;
}

void show_progress(ProgressDisplay& display, const server::RunInfo& info) {
  const std::string done = "frame " + std::to_string(info.frames);
  if (info.frames_total == 0) {
    display.show_so_far(done);
    return;
  }
  display.show(static_cast<double>(info.frames) / static_cast<double>(info.frames_total),
               done + " of " + std::to_string(info.frames_total));
}

/// Reports the estimators that never ran. @return a failure if none ran
int exit_code_of_estimators(const server::RunMetrics& metrics) {
  const std::map<std::string, std::string> reasons = server::never_ran(metrics);
  for (const auto& [name, reason] : reasons) {
    std::cerr << "error: estimator " << name << " never ran: " << reason << "\n";
  }
  const bool none_ran = !reasons.empty() && reasons.size() == metrics.estimators.size();
  return none_ran ? kExitFailure : kExitOk;
}

std::optional<server::FrameFolderOptions> frame_cache_of(const RunArguments& arguments) {
  if (arguments.frame_cache.empty()) return std::nullopt;
  server::FrameFolderOptions options;
  options.folder = std::filesystem::absolute(arguments.frame_cache);
  options.budget_bytes =
      static_cast<std::uint64_t>(arguments.frame_cache_gib * static_cast<double>(1ULL << 30U));
  options.keep_since_ns =
      arguments.frame_cache_since_ns != 0 ? arguments.frame_cache_since_ns : server::utc_now_ns();
  return options;
}

int run(const RunArguments& arguments) {
  const Result<server::Scenario> scenario = load_to_fly(arguments);
  if (!scenario) return report(scenario.error());
  Result<server::RunResult> result = Error{};
  {
    ProgressDisplay display(arguments.quiet);
    server::RunOptions options;
    options.folder = arguments.out;
    options.cancel = &catch_stop_signals();
    options.frame_cache = frame_cache_of(arguments);
    options.warn = [&](const std::string& text) { display.warn("warning: " + text); };
    options.notice = [&](const std::string& text) { display.note(text); };
    options.progress = [&](const server::RunInfo& info) { show_progress(display, info); };
    result = server::run_scenario(*scenario, options);
  }
  if (!result) return report(result.error());
  if (arguments.json) {
    std::cout << server::json_from(result->metrics).dump(2) << "\n";
  } else {
    std::cout << score_table(result->metrics, evaluation::AlignmentMode::kInitScale)
              << camera_notes(result->metrics) << "run folder: " << arguments.out << "\n";
  }
  if (result->info.status == server::RunStatus::kCancelled) {
    std::cerr << "cancelled after frame " << result->info.frames << "\n";
    return kExitCancelled;
  }
  return exit_code_of_estimators(result->metrics);
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Fly one scenario and score its estimators");
  command->add_option("scenario", arguments->scenario, "Scenario file (JSON)")->required();
  command->add_option("--out", arguments->out, "Run folder to create")->required();
  command->add_option("--set", arguments->sets, "Override a field: path=value, e.g. seed=2")
      ->allow_extra_args(false);
  command->add_option("--renderer", arguments->renderer, "Renderer of the camera's image")
      ->check(CLI::IsMember({"auto", "egl", "raycast"}));
  CLI::Option* folders =
      command
          ->add_option("--files-in",
                       arguments->folders,
                       "Folder whose files the scenario may name; repeatable. Without it any file "
                       "may be named; with it none outside of these folders, and no network")
          ->allow_extra_args(false);
  command
      ->add_option("--files-not-in",
                   arguments->closed,
                   "Folder in those whose files may not be named; repeatable")
      ->allow_extra_args(false)
      ->needs(folders);
  command->add_option("--frame-cache",
                      arguments->frame_cache,
                      "Folder of rendered pictures of other flights, which gets those of this one");
  CLI::Option* gib = command
                         ->add_option("--frame-cache-gib",
                                      arguments->frame_cache_gib,
                                      "Size of that folder at most [GiB]; 0: it is only read")
                         ->check(CLI::Range(0.0, kMostFrameCacheGib))
                         ->capture_default_str();
  // For series of flights, whose processes must not remove each other's pictures.
  command->add_option("--frame-cache-since-ns", arguments->frame_cache_since_ns)
      ->needs(gib)
      ->group("");
  command->add_flag("--json", arguments->json, "Print metrics.json instead of a table");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace overfly::app
