// overfly sweep: flies a scenario with changed fields, many times, here or by workers elsewhere.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/text/number_text.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/frame_cache_options.hpp"
#include "server/app/output_files.hpp"
#include "server/app/progress.hpp"
#include "server/app/score_table.hpp"
#include "server/app/stop_signal.hpp"
#include "server/experiments/fly_sweep.hpp"
#include "server/experiments/jobs/folder_executor.hpp"
#include "server/experiments/jobs/job_worker.hpp"
#include "server/experiments/jobs/slurm_workers.hpp"
#include "server/experiments/sweep_folders.hpp"
#include "server/experiments/sweep_summary.hpp"
#include "server/files/program_identity.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace experiments = server::experiments;

/// Jobs of a folder that wait or fly at the same time: a sweep of any size keeps its folder small.
constexpr std::size_t kMostOpenJobs = 1000;

struct SweepArguments {
  std::string file;
  std::string out;
  std::size_t jobs = 0;
  std::string executor = "local";
  std::vector<std::string> slurm_options;
  double lease_s = 180.0;
  std::string alignment = "init_scale";
  FrameCacheArguments frame_cache;
  bool dry_run = false;
  bool json = false;
  bool quiet = false;
};

/// "1 h 05 min", "12 min", "40 s"
std::string duration_words(double seconds) {
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
  if (progress.spent_s > 0.0) text += ", " + duration_words(progress.spent_s) + " flown";
  if (progress.left_s.value_or(0.0) > 0.0) {
    text += ", about " + duration_words(*progress.left_s) + " left";
  }
  display.show(static_cast<double>(progress.passed) / static_cast<double>(progress.most), text);
}

std::size_t default_jobs() { return std::max(1U, std::thread::hardware_concurrency() / 2); }

using Executor = std::unique_ptr<experiments::FlightExecutor>;

Result<Executor> open_executor(const SweepArguments& arguments,
                               const std::function<void(const std::string&)>& warn) {
  const fs::path sweep = fs::absolute(arguments.out);
  experiments::FolderExecutorOptions options;
  options.version = server::program_identity();
  options.lease_s = arguments.lease_s;
  options.warn = warn;
  if (arguments.executor == "slurm") {
    std::error_code error;
    experiments::SlurmOptions slurm;
    slurm.sweep = sweep;
    slurm.program = fs::read_symlink("/proc/self/exe", error);
    if (error) {
      return Error{ErrorCode::kIo, "/proc/self/exe: cannot read: " + error.message()};
    }
    if (arguments.jobs != 0) slurm.workers = arguments.jobs;
    slurm.submit_options = arguments.slurm_options;
    if (!arguments.frame_cache.folder.empty()) {
      slurm.worker_options = {"--frame-cache",
                              fs::absolute(arguments.frame_cache.folder).string(),
                              "--frame-cache-gib",
                              number_text(arguments.frame_cache.gib)};
    }
    slurm.warn = warn;
    auto workers = experiments::SlurmWorkers::open(std::move(slurm));
    if (!workers) return workers.error();
    options.supply = std::move(*workers);
  }
  auto executor = experiments::FolderExecutor::open(sweep, std::move(options));
  if (!executor) return executor.error();
  return Executor(std::move(*executor));
}

Result<experiments::FlownSweep> fly(const experiments::Sweep& sweep,
                                    const SweepArguments& arguments) {
  ProgressDisplay display(arguments.quiet);
  experiments::SweepOptions options;
  options.folder = fs::absolute(arguments.out);
  options.program = "/proc/self/exe";
  options.jobs = arguments.jobs == 0 ? default_jobs() : arguments.jobs;
  options.frame_cache = frame_cache_from(arguments.frame_cache, options.folder);
  options.cancel = &catch_stop_signals();
  options.progress = [&](const experiments::SweepProgress& progress) {
    show_sweep(display, progress);
  };
  options.warn = [&](const std::string& text) { display.warn("warning: " + text); };
  if (arguments.executor != "local") {
    options.jobs = kMostOpenJobs;
    options.open_executor = [&] { return open_executor(arguments, options.warn); };
  }
  if (arguments.executor == "folder") {
    display.note("workers fly it: overfly sweep work " + arguments.out);
  }
  Result<experiments::FlownSweep> flown = experiments::fly_sweep(sweep, options);
  if (flown && flown->pictures.read > 0) display.note(pictures_text(flown->pictures));
  return flown;
}

void print_sweep_plan(const experiments::FlownSweep& flown) {
  for (const std::string& absent : flown.plan.absent_programs()) {
    std::cerr << "warning: " << absent << "\n";
  }
  const auto& progress = flown.progress;
  std::cout << counted(flown.plan.cells().size(), "cell") << ", "
            << counted(flown.plan.estimators().size(), "estimator") << ", at most "
            << counted(progress.most, "flight") << "; " << (progress.most - progress.passed)
            << " to be flown\n";
}

struct WorkArguments {
  std::string sweep;
  std::size_t jobs = 0;
  std::size_t flights = 0;
  double idle_s = 60.0;
  FrameCacheArguments frame_cache;
  bool quiet = false;
};

int work(const WorkArguments& arguments) {
  constexpr std::chrono::milliseconds kStep{50};
  const std::atomic<bool>& cancel = catch_stop_signals();
  experiments::WorkerOptions options;
  options.sweep = fs::absolute(arguments.sweep);
  options.program = "/proc/self/exe";
  options.version = server::program_identity();
  options.jobs = arguments.jobs == 0 ? default_jobs() : arguments.jobs;
  if (arguments.flights != 0) options.most_flights = arguments.flights;
  options.idle_s = arguments.idle_s;
  if (!arguments.frame_cache.folder.empty()) {
    options.frame_cache = frame_cache_from(arguments.frame_cache, options.sweep);
  }
  if (!arguments.quiet) {
    options.note = [](const std::string& text) { std::cerr << text << std::endl; };
  }
  options.warn = [](const std::string& text) { std::cerr << "warning: " << text << std::endl; };
  Result<experiments::JobWorker> worker = experiments::JobWorker::start(std::move(options));
  if (!worker) return report(worker.error());
  Result<bool> more = true;
  while (!cancel && more && *more) {
    more = worker->step();
    std::this_thread::sleep_for(kStep);
  }
  const Status stopped = worker->stop();
  if (!more) return report(more.error());
  if (!stopped) return report(stopped.error());
  std::cout << counted(worker->flown(), "flight") << " delivered\n";
  return cancel ? kExitCancelled : kExitOk;
}

/// What is wrong with the options together; empty if nothing is.
std::string misuse(const CLI::App& command, const SweepArguments& arguments) {
  constexpr std::size_t kMostLocalJobs = 256;
  if (arguments.file.empty()) return "sweep: a sweep file is required";
  if (arguments.out.empty()) return "--out: is required";
  const std::string& executor = arguments.executor;
  if (executor == "local" && arguments.jobs > kMostLocalJobs) {
    return "--jobs = " + std::to_string(arguments.jobs) + ": must be in [0, 256] without Slurm";
  }
  if (executor == "folder" && command.count("--jobs") > 0) {
    return "--jobs: is an option of the workers with --executor folder";
  }
  if (executor != "slurm" && command.count("--slurm-option") > 0) {
    return "--slurm-option: needs --executor slurm";
  }
  for (const char* option : {"--frame-cache", "--frame-cache-gib"}) {
    if (executor == "folder" && command.count(option) > 0) {
      return std::string(option) + ": is an option of the workers with --executor folder";
    }
  }
  if (executor == "slurm" && command.count("--frame-cache-gib") > command.count("--frame-cache")) {
    return "--frame-cache-gib: needs --frame-cache with Slurm: a folder on the nodes";
  }
  if (executor == "local" && command.count("--lease-s") > 0) {
    return "--lease-s: needs --executor folder or slurm";
  }
  return "";
}

int sweep(const SweepArguments& arguments) {
  if (Status status = check_not_written(
          "sweep", arguments.file, arguments.out, {"sweep.json", "progress.json"});
      !status) {
    return report(status.error());
  }
  const Result<experiments::Sweep> sweep = experiments::load_sweep(arguments.file);
  if (!sweep) return report(sweep.error());
  if (Status status = experiments::check_sweep_folder(arguments.out); !status) {
    return report(status.error().in("--out"));
  }
  const Result<experiments::FlownSweep> flown =
      arguments.dry_run ? experiments::read_sweep(*sweep, arguments.out, &catch_stop_signals())
                        : fly(*sweep, arguments);
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
  return flown->progress.failed > 0 ? kExitIncomplete : kExitOk;
}

void add_work_command(CLI::App& sweep_command, int& exit_code) {
  const auto arguments = std::make_shared<WorkArguments>();
  CLI::App* command =
      sweep_command.add_subcommand("work", "Fly flights of a sweep that another process controls");
  command->add_option("sweep", arguments->sweep, "Folder of the sweep")->required();
  command->add_option("--jobs", arguments->jobs, "Flights at the same time; 0: half the processors")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  command->add_option("--flights", arguments->flights, "End after so many flights; 0: no limit")
      ->capture_default_str();
  command->add_option("--idle-s", arguments->idle_s, "End after so many seconds without a flight")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  add_frame_cache_options(*command, arguments->frame_cache, "none");
  command->get_option("--frame-cache-gib")->needs(command->get_option("--frame-cache"));
  command->add_flag("--quiet", arguments->quiet, "No messages about flights");
  command->callback([arguments, &exit_code] { exit_code = work(*arguments); });
}

}  // namespace

void add_sweep_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App* command =
      app.add_subcommand("sweep", "Fly a scenario with changed fields, many times, and compare");
  command->add_option("sweep", arguments->file, "Sweep file (JSON)");
  command->add_option("--out",
                      arguments->out,
                      "Folder of the sweep; one that exists is continued with what it lacks");
  command
      ->add_option("--jobs",
                   arguments->jobs,
                   "Flights at the same time; 0: half the processors. With Slurm: tasks at the "
                   "same time; 0: 64")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command
      ->add_option("--executor",
                   arguments->executor,
                   "Who flies: processes of this machine, workers that you start (folder), or "
                   "tasks of Slurm")
      ->check(CLI::IsMember({"local", "folder", "slurm"}))
      ->capture_default_str();
  command->add_option("--slurm-option", arguments->slurm_options, "A further option of sbatch")
      ->allow_extra_args(false);
  command
      ->add_option("--lease-s",
                   arguments->lease_s,
                   "A worker that shows no sign of life for so long loses its flights [s]")
      ->check(CLI::Range(10.0, 1e6))
      ->capture_default_str();
  command->add_option("--alignment", arguments->alignment, "Alignment of the errors in the table")
      ->check(CLI::IsMember(alignment_mode_names()))
      ->capture_default_str();
  add_frame_cache_options(*command, arguments->frame_cache);
  command->add_flag("--dry-run", arguments->dry_run, "Check everything and count the flights");
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  add_work_command(*command, exit_code);
  command->callback([arguments, command, &exit_code] {
    if (!command->get_subcommands().empty()) return;
    const std::string wrong = misuse(*command, *arguments);
    exit_code =
        wrong.empty() ? sweep(*arguments) : report(Error{ErrorCode::kInvalidArgument, wrong});
  });
}

}  // namespace overfly::app
