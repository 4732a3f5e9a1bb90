// overfly envelope: how far along an axis of a sweep an estimator survives.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "core/text/number_text.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/frame_cache_options.hpp"
#include "server/app/output_files.hpp"
#include "server/app/progress.hpp"
#include "server/app/score_table.hpp"
#include "server/app/stop_signal.hpp"
#include "server/experiments/envelope/envelope.hpp"
#include "server/experiments/sweep_folders.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace experiments = server::experiments;

struct EnvelopeArguments {
  std::string file;
  std::string out;
  std::string axis;
  std::string estimator;
  FrameCacheArguments frame_cache;
  std::size_t jobs = 0;
  bool json = false;
  bool quiet = false;
};

int envelope(const EnvelopeArguments& arguments) {
  if (Status status = check_not_written(
          "sweep", arguments.file, arguments.out, {"sweep.json", "progress.json", "envelope.json"});
      !status) {
    return report(status.error());
  }
  const Result<experiments::Sweep> sweep = experiments::load_sweep(arguments.file);
  if (!sweep) return report(sweep.error());
  if (Status status = experiments::check_sweep_folder(arguments.out); !status) {
    return report(status.error().in("--out"));
  }
  Result<experiments::Envelope> found = [&] {
    ProgressDisplay display(arguments.quiet);
    experiments::EnvelopeOptions options;
    options.border = {arguments.axis, arguments.estimator};
    options.flights.folder = fs::absolute(arguments.out);
    options.flights.frame_cache = frame_cache_from(arguments.frame_cache, options.flights.folder);
    options.flights.program = "/proc/self/exe";
    options.flights.jobs = arguments.jobs == 0
                               ? std::max(1U, std::thread::hardware_concurrency() / 2)
                               : arguments.jobs;
    options.flights.cancel = &catch_stop_signals();
    options.flights.warn = [&](const std::string& text) { display.warn("warning: " + text); };
    options.progress = [&](std::size_t cells) { display.show_so_far(counted(cells, "cell")); };
    return experiments::find_envelope(*sweep, options);
  }();
  if (!found) {
    if (found.error().code == ErrorCode::kCancelled) {
      std::cerr << "cancelled; the same command continues\n";
      return kExitCancelled;
    }
    return report(found.error());
  }
  if (Status status = experiments::write_envelope(arguments.out, *found); !status) {
    return report(status.error());
  }
  if (arguments.json) {
    std::cout << experiments::json_from(*found).dump(2) << "\n";
  } else {
    std::cout << experiments::markdown_from(*sweep, *found);
  }
  return kExitOk;
}

}  // namespace

void add_envelope_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<EnvelopeArguments>();
  CLI::App* command = app.add_subcommand(
      "envelope", "Find how far along an axis of a sweep an estimator survives, by bisection");
  command->add_option("sweep", arguments->file, "Sweep file (JSON)")->required();
  command
      ->add_option("--out", arguments->out, "Folder of the sweep; what it has is not flown again")
      ->required();
  command->add_option("--along", arguments->axis, "Path or name of the axis")->required();
  command->add_option("--estimator", arguments->estimator, "Estimator; default: the first one");
  command->add_option("--jobs", arguments->jobs, "Flights at the same time; 0: half the processors")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  add_frame_cache_options(*command, arguments->frame_cache);
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = envelope(*arguments); });
}

}  // namespace overfly::app
