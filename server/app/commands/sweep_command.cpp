// overfly sweep: flies a scenario with changed fields, many times.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/text/number_text.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/progress.hpp"
#include "server/app/score_table.hpp"
#include "server/app/stop_signal.hpp"
#include "server/experiments/fly_sweep.hpp"
#include "server/experiments/sweep_summary.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace experiments = server::experiments;

struct SweepArguments {
  std::string file;
  std::string out;
  std::size_t jobs = 0;
  std::string alignment = "init_scale";
  bool dry_run = false;
  bool json = false;
  bool quiet = false;
};

/// "1 h 05 min", "12 min", "40 s"
std::string time_left_text(double seconds) {
  const auto whole = static_cast<long>(seconds);
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min";
  const std::string minutes = std::to_string(whole / 60 % 60);
  return std::to_string(whole / 3600) + " h " + (minutes.size() < 2 ? "0" : "") + minutes + " min";
}

void show_sweep(ProgressDisplay& display, const experiments::SweepProgress& progress) {
  std::string text =
      "flight " + std::to_string(progress.passed) + " of " + std::to_string(progress.most);
  if (progress.failed > 0) text += ", " + std::to_string(progress.failed) + " failed";
  if (progress.left_s > 0.0) text += ", about " + time_left_text(progress.left_s) + " left";
  display.show(static_cast<double>(progress.passed) / static_cast<double>(progress.most), text);
}

std::size_t default_jobs() { return std::max(1U, std::thread::hardware_concurrency() / 2); }

Result<experiments::FlownSweep> fly(const experiments::Sweep& sweep,
                                    const SweepArguments& arguments) {
  ProgressDisplay display(arguments.quiet);
  experiments::SweepOptions options;
  options.folder = fs::absolute(arguments.out);
  options.program = "/proc/self/exe";
  options.jobs = arguments.jobs == 0 ? default_jobs() : arguments.jobs;
  options.cancel = &catch_stop_signals();
  options.progress = [&](const experiments::SweepProgress& progress) {
    show_sweep(display, progress);
  };
  options.warn = [&](const std::string& text) { display.warn("warning: " + text); };
  return experiments::fly_sweep(sweep, options);
}

void print_sweep_plan(const experiments::FlownSweep& flown) {
  const auto& progress = flown.progress;
  std::cout << counted(flown.plan.cells().size(), "cell") << ", "
            << counted(flown.plan.estimators().size(), "estimator") << ", at most "
            << counted(progress.most, "flight") << "; " << (progress.most - progress.passed)
            << " to be flown\n";
}

int sweep(const SweepArguments& arguments) {
  const Result<experiments::Sweep> sweep = experiments::load_sweep(arguments.file);
  if (!sweep) return report(sweep.error());
  const Result<experiments::FlownSweep> flown =
      arguments.dry_run ? experiments::read_sweep(*sweep, arguments.out) : fly(*sweep, arguments);
  if (!flown) return report(flown.error());
  if (arguments.dry_run) {
    print_sweep_plan(*flown);
    return kExitOk;
  }
  const auto mode = evaluation::alignment_mode_from(arguments.alignment).value();
  const auto summary = experiments::summary_of(*flown, arguments.out, mode);
  const std::string table = experiments::markdown_from(*sweep, summary, mode);
  const fs::path file = fs::path(arguments.out) / "summary.md";
  if (Status status = server::write_whole(file, table); !status) return report(status.error());
  if (arguments.json) {
    std::cout << experiments::json_from(summary).dump(2) << "\n";
  } else {
    std::cout << table;
  }
  if (flown->cancelled) {
    std::cerr << "cancelled after flight " << flown->progress.passed << " of "
              << flown->progress.most << "; the same command continues\n";
    return kExitCancelled;
  }
  return flown->progress.failed > 0 ? kExitFailure : kExitOk;
}

}  // namespace

void add_sweep_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App* command =
      app.add_subcommand("sweep", "Fly a scenario with changed fields, many times, and compare");
  command->add_option("sweep", arguments->file, "Sweep file (JSON)")->required();
  command
      ->add_option("--out",
                   arguments->out,
                   "Folder of the sweep; one that exists is continued with what it lacks")
      ->required();
  command->add_option("--jobs", arguments->jobs, "Flights at the same time; 0: half the processors")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  command->add_option("--alignment", arguments->alignment, "Alignment of the errors in the table")
      ->check(CLI::IsMember(alignment_mode_names()))
      ->capture_default_str();
  command->add_flag("--dry-run", arguments->dry_run, "Check everything and count the flights");
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = sweep(*arguments); });
}

}  // namespace overfly::app
