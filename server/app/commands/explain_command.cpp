// overfly explain: why an estimator failed, by flying the critical part with one cause changed.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "server/app/commands/commands.hpp"
#include "server/app/exit_code.hpp"
#include "server/app/file_limits.hpp"
#include "server/app/frame_cache_options.hpp"
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "server/experiments/explain/explain_run.hpp"
#include "server/experiments/explain/explained_run.hpp"
#include "server/experiments/explain/explanation_json.hpp"
#include "server/experiments/explain/explanation_page.hpp"
#include "server/experiments/explain/explanation_words.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace experiments = server::experiments;

struct ExplainArguments {
  std::string run;
  std::string out;
  std::string estimator;
  std::vector<std::string> causes;
  std::size_t flights = 12;
  FrameCacheArguments frame_cache;
  std::size_t jobs = 0;
  FileLimits files;
  std::string progress;
  bool json = false;
  bool quiet = false;
};

std::vector<std::string> cause_names() {
  std::vector<std::string> names;
  for (const experiments::Cause cause : experiments::all_causes()) {
    names.emplace_back(experiments::to_string(cause));
  }
  return names;
}

experiments::ExplainOptions explain_options_from(const ExplainArguments& arguments,
                                                 const fs::path& folder,
                                                 ProgressDisplay& display) {
  experiments::ExplainOptions options;
  options.estimator = arguments.estimator;
  for (const std::string& name : arguments.causes) {
    options.causes.push_back(experiments::cause_from(name).value());
  }
  options.flights.folder = folder;
  options.flights.frame_cache = frame_cache_from(arguments.frame_cache, folder);
  options.flights.program = "/proc/self/exe";
  options.flights.jobs =
      arguments.jobs == 0 ? std::max(1U, std::thread::hardware_concurrency() / 2) : arguments.jobs;
  options.flights.most_flights = arguments.flights;
  options.flights.sources = apply(arguments.files);
  options.flights.flight_options = arguments.files.options();
  options.flights.cancel = &catch_stop_signals();
  options.flights.progress = [&display, most = arguments.flights](std::size_t done,
                                                                  const std::string& name) {
    display.show(
        static_cast<double>(done) / static_cast<double>(most),
        std::to_string(done) + " of at most " + std::to_string(most) + " flights, " + name);
  };
  return options;
}

void print_explanation(const experiments::Explanation& explanation, const fs::path& folder) {
  for (const std::string& sentence : experiments::sentences_of(explanation)) {
    std::cout << sentence << "\n";
  }
  if (explanation.flights.empty()) return;
  std::cout << "\n";
  std::size_t width = 0;
  for (const auto& flight : explanation.flights) width = std::max(width, flight.name.size());
  for (const auto& flight : explanation.flights) {
    std::cout << "  " << flight.name << std::string(width - flight.name.size() + 2, ' ')
              << experiments::result_words(flight) << "\n";
  }
  std::cout << "\n" << (folder / "explanation.html").string() << "\n";
}

/// explained/RUN, or explained/RUN_ESTIMATOR of a run with several estimators: the explanation of
/// one must not replace that of another. Errors: as read_explained_run.
Result<fs::path> default_folder(const ExplainArguments& arguments, const fs::path& run) {
  const auto explained =
      experiments::read_explained_run(run, arguments.estimator, apply(arguments.files));
  if (!explained) return explained.error();
  const bool alone = explained->document.at("estimators").size() == 1;
  return fs::path("explained") /
         (server::folder_name(run) + (alone ? "" : "_" + explained->estimator_name));
}

int explain(const ExplainArguments& arguments) {
  const fs::path run = fs::absolute(arguments.run).lexically_normal();
  const Result<fs::path> out =
      arguments.out.empty() ? default_folder(arguments, run) : Result<fs::path>(arguments.out);
  if (!out) return report(out.error());
  const fs::path folder = fs::absolute(*out);
  Result<experiments::Explanation> explanation = [&] {
    ProgressDisplay display(arguments.quiet, arguments.progress);
    return experiments::explain_run(run, explain_options_from(arguments, folder, display));
  }();
  if (!explanation) return report(explanation.error());
  if (arguments.frame_cache.folder.empty()) {
    // Its own one: no further flight has these pictures.
    std::error_code ignored;
    fs::remove_all(folder / experiments::kFrameCacheFolder, ignored);
  }
  const auto document = experiments::json_from(*explanation, folder);
  if (!explanation->succeeded) {
    Status status = server::write_json(folder / "explanation.json", document);
    if (status) {
      status = server::write_whole(folder / "explanation.html",
                                   experiments::page_of(*explanation, folder));
    }
    if (!status) return report(status.error());
  }
  if (arguments.json) {
    std::cout << document.dump(2) << "\n";
  } else {
    print_explanation(*explanation, folder);
  }
  return kExitOk;
}

}  // namespace

void add_explain_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ExplainArguments>();
  CLI::App* command = app.add_subcommand(
      "explain", "Find out why an estimator failed: fly it again with one cause changed at a time");
  command->add_option("run", arguments->run, "Run folder")->required();
  command->add_option("--out",
                      arguments->out,
                      "Folder of the explanation; one that exists is continued. Default: "
                      "explained/RUN, or explained/RUN_ESTIMATOR if the run has several");
  command->add_option("--estimator",
                      arguments->estimator,
                      "Estimator to be explained. Default: the first one that failed");
  command->add_option("--causes", arguments->causes, "Causes to be tried, instead of all")
      ->delimiter(',')
      ->check(CLI::IsMember(cause_names()));
  command->add_option("--flights", arguments->flights, "Flights at most")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  command->add_option("--jobs", arguments->jobs, "Flights at the same time; 0: half the processors")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  add_file_limits(*command, arguments->files, "the run's scenario");
  command->add_option("--progress", arguments->progress, "File for the progress, as JSON");
  add_frame_cache_options(*command, arguments->frame_cache);
  command->add_flag("--json", arguments->json, "Print JSON instead of sentences");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = explain(*arguments); });
}

}  // namespace overfly::app
