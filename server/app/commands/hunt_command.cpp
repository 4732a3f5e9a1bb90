// overfly hunt: searches the worst flight of a scenario within limits.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "core/text/number_text.hpp"
#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/file_limits.hpp"
#include "server/app/frame_cache_options.hpp"
#include "server/app/output_files.hpp"
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "server/experiments/hunt/hunt.hpp"
#include "server/experiments/hunt/hunt_output.hpp"
#include "server/experiments/sweep_folders.hpp"
#include "server/files/whole_file.hpp"
#include "server/scenario/document/scenario_override.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace experiments = server::experiments;
using Json = nlohmann::json;

struct HuntArguments {
  std::string file;
  std::string out;
  std::vector<std::string> axes;
  std::vector<std::string> changes;
  std::string estimator;
  std::optional<std::string> method;
  std::optional<std::size_t> flights;
  std::optional<std::size_t> repeats;
  std::optional<std::size_t> batch;
  std::optional<std::uint64_t> seed;
  std::optional<double> position_rmse_limit_m;
  bool all = false;
  FrameCacheArguments frame_cache;
  std::size_t jobs = 0;
  FileLimits files;
  std::string progress;
  bool json = false;
  bool quiet = false;
};

/// Puts an option in the place of the file's field.
template <typename T>
void replace(Json& document, const char* name, const std::optional<T>& value) {
  if (value) document[name] = *value;
}

/// Replaces the axis of the same path, or adds one. Other types are left to the check of the
/// document.
void put_axis(Json& axes, const Json& axis) {
  if (!axes.is_array()) return;
  for (Json& old : axes) {
    if (old.is_object() && old.value("path", Json()) == axis.at("path")) {
      old = axis;
      return;
    }
  }
  axes.push_back(axis);
}

Result<experiments::Hunt> hunt_from(const HuntArguments& arguments) {
  Result<Json> document = experiments::read_hunt_document(arguments.file);
  if (!document) return document.error();
  for (const std::string& text : arguments.axes) {
    const Result<Json> axis = experiments::parse_axis(text);
    if (!axis) return axis.error();
    put_axis((*document)["axes"], *axis);
  }
  const auto changes = server::parse_overrides(arguments.changes);
  if (!changes) return changes.error();
  for (const server::Override& change : *changes) {
    Json& set = (*document)["set"];
    if (set.is_null() || set.is_object()) set[change.path] = change.value;
  }
  if (document->at("axes").empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 arguments.file + ": a scenario needs limits: --axis PATH=FROM:TO"};
  }
  replace(*document, "method", arguments.method);
  replace(*document, "most_flights", arguments.flights);
  replace(*document, "repeats", arguments.repeats);
  replace(*document, "batch", arguments.batch);
  replace(*document, "seed", arguments.seed);
  replace(*document, "position_rmse_limit_m", arguments.position_rmse_limit_m);
  if (arguments.all) (*document)["until"] = "flights";
  const fs::path folder = fs::absolute(arguments.file).parent_path().lexically_normal();
  auto hunt = experiments::resolve_hunt(
      std::move(*document), folder, arguments.estimator, {apply(arguments.files), {}});
  if (!hunt) return hunt.error().in(arguments.file);
  return hunt;
}

std::string progress_text(const experiments::Hunt& hunt, const experiments::HuntResult& result) {
  const experiments::HuntedFlight* worst = result.worst();
  return std::to_string(result.flights.size()) + " of at most " +
         counted(hunt.most_flights, "flight") +
         (worst == nullptr ? "" : "; the worst one " + experiments::result_text(*worst));
}

/// hunt.json, and worst.json if a flight was flown.
Status write_results(const experiments::Hunt& hunt,
                     const experiments::HuntResult& result,
                     const fs::path& folder) {
  const Json document = experiments::json_from(hunt, result);
  if (Status status = server::write_json(folder / "hunt.json", document); !status) return status;
  if (result.worst() == nullptr) return {};
  const Result<Json> scenario = experiments::scenario_document(hunt, *result.worst());
  if (!scenario) return scenario.error();
  return server::write_json(folder / "worst.json", *scenario);
}

Result<experiments::HuntResult> fly_from(const experiments::Hunt& hunt,
                                         const HuntArguments& arguments) {
  ProgressDisplay display(arguments.quiet, arguments.progress);
  experiments::HuntOptions options;
  options.flights.folder = fs::absolute(arguments.out);
  options.flights.frame_cache = frame_cache_from(arguments.frame_cache, options.flights.folder);
  options.flights.program = "/proc/self/exe";
  options.flights.flight_options = arguments.files.options();
  options.flights.jobs =
      arguments.jobs == 0 ? std::max(1U, std::thread::hardware_concurrency() / 2) : arguments.jobs;
  options.flights.cancel = &catch_stop_signals();
  options.flights.warn = [&](const std::string& text) { display.warn("warning: " + text); };
  options.progress = [&](const experiments::HuntResult& result) {
    // Who follows the hunt sees what it has found; the end reports files that cannot be written.
    if (!result.flights.empty()) (void)write_results(hunt, result, options.flights.folder);
    display.show(
        static_cast<double>(result.flights.size()) / static_cast<double>(hunt.most_flights),
        progress_text(hunt, result));
  };
  return experiments::fly_hunt(hunt, options);
}

/// Makes the folder one of a hunt before anything is flown into it: a hunt that is stopped at any
/// time can be continued.
Status begin_folder(const experiments::Hunt& hunt, const fs::path& folder) {
  if (Status status = experiments::check_hunt_folder(folder); !status) {
    return status.error().in("--out");
  }
  std::error_code failure;
  if (fs::exists(folder / "hunt.json", failure)) return {};
  fs::create_directories(folder, failure);
  if (failure) {
    return Error{ErrorCode::kIo, folder.string() + ": cannot create: " + failure.message()};
  }
  return write_results(hunt, {}, folder);
}

int hunt(const HuntArguments& arguments) {
  if (Status status = check_not_written("scenario",
                                        arguments.file,
                                        arguments.out,
                                        {"hunt.json", "worst.json", "sweep.json", "progress.json"});
      !status) {
    return report(status.error());
  }
  const Result<experiments::Hunt> hunt = hunt_from(arguments);
  if (!hunt) return report(hunt.error());
  if (Status status = begin_folder(*hunt, arguments.out); !status) return report(status.error());
  const Result<experiments::HuntResult> result = fly_from(*hunt, arguments);
  if (!result) return report(result.error());
  const fs::path folder = arguments.out;
  if (Status status = write_results(*hunt, *result, folder); !status) return report(status.error());
  if (arguments.json) {
    std::cout << experiments::json_from(*hunt, *result).dump(2) << "\n";
  } else {
    std::cout << experiments::markdown_from(*hunt, *result) << "\n"
              << experiments::summary_text(*hunt, *result);
    if (result->worst() != nullptr) {
      std::cout << "Fly it again: overfly run " << (folder / "worst.json").string()
                << " --out RUN\n";
    }
  }
  if (!result->cancelled) return kExitOk;
  std::cerr << "cancelled after " << counted(result->flights.size(), "flight")
            << "; the same command continues\n";
  return kExitCancelled;
}

}  // namespace

void add_hunt_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<HuntArguments>();
  CLI::App* command =
      app.add_subcommand("hunt", "Search the worst flight of a scenario within limits");
  command->add_option("scenario", arguments->file, "Scenario or hunt file (JSON)")->required();
  command->add_option("--out", arguments->out, "Folder of the hunt; one that exists is continued")
      ->required();
  command
      ->add_option("--axis",
                   arguments->axes,
                   "Field of the scenario and its limits: PATH=FROM:TO or PATH=FROM:TO:STEP")
      ->allow_extra_args(false);
  command->add_option("--set", arguments->changes, "Change a field in every flight: path=value")
      ->allow_extra_args(false);
  command->add_option(
      "--estimator", arguments->estimator, "Estimator of the scenario. Default: the first one");
  command->add_option("--method", arguments->method, "How points are chosen. Default: model")
      ->check(CLI::IsMember({"model", "random"}));
  command->add_option("--flights", arguments->flights, "Flights at most. Default: 60")
      ->check(CLI::Range(1, 500));
  command->add_option("--repeats", arguments->repeats, "Seeds of each point. Default: 1")
      ->check(CLI::Range(1, 20));
  command->add_option("--batch", arguments->batch, "Points that are chosen together. Default: 1")
      ->check(CLI::Range(1, 64));
  command->add_option("--seed", arguments->seed, "Seed of the search. Default: 1");
  command
      ->add_option("--position-rmse-limit-m",
                   arguments->position_rmse_limit_m,
                   "A larger error is a failure too")
      ->check(CLI::PositiveNumber);
  command->add_flag("--all", arguments->all, "Do not stop at the first failure: find the worst");
  command->add_option("--jobs", arguments->jobs, "Flights at the same time; 0: half the processors")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  add_file_limits(*command, arguments->files, "the scenario");
  command->add_option("--progress", arguments->progress, "File for the progress, as JSON");
  add_frame_cache_options(*command, arguments->frame_cache);
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = hunt(*arguments); });
}

}  // namespace overfly::app
