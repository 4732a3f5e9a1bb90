// overfly predict: where an estimator is likely to lose track, before anything is flown.
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
#include "server/app/progress.hpp"
#include "server/app/stop_signal.hpp"
#include "server/experiments/predict/predict.hpp"
#include "server/experiments/predict/prediction_json.hpp"
#include "server/experiments/predict/prediction_page.hpp"
#include "server/experiments/predict/prediction_words.hpp"
#include "server/files/whole_file.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/scenario/document/scenario_override.hpp"

namespace overfly::app {
namespace {

namespace fs = std::filesystem;
namespace prediction = server::predict;

struct PredictArguments {
  std::string scenario;
  std::vector<std::string> sets;
  std::string out;
  std::string camera;
  double rate_hz = 2.0;
  double map_km = 10.0;
  double cell_m = 100.0;
  bool no_map = false;
  unsigned jobs = 0;
  FileLimits files;
  std::string progress;
  bool json = false;
  bool quiet = false;
};

Result<server::Scenario> load_to_predict(const PredictArguments& arguments) {
  const auto overrides = server::parse_overrides(arguments.sets);
  if (!overrides) return overrides.error();
  const SourcePolicy sources = apply(arguments.files);
  Result<server::Scenario> scenario =
      server::load_scenario(arguments.scenario, *overrides, sources);
  if (!scenario) return scenario.error();
  scenario->sources = sources;
  if (Status status = server::check_scenario(*scenario); !status) return status.error();
  return scenario;
}

Result<prediction::Predicted> predict_quietly_or_not(const PredictArguments& arguments,
                                                     const server::Scenario& scenario) {
  ProgressDisplay display(arguments.quiet, arguments.progress);
  prediction::PredictOptions options;
  options.camera = arguments.camera;
  options.rate_hz = arguments.rate_hz;
  options.map.reset();
  if (!arguments.no_map) {
    options.map = prediction::PredictOptions::Map{
        1000.0 * arguments.map_km, arguments.cell_m, !arguments.out.empty()};
  }
  options.jobs =
      arguments.jobs == 0 ? std::max(1U, std::thread::hardware_concurrency()) : arguments.jobs;
  options.cancel = &catch_stop_signals();
  options.progress = [&display](double share, const std::string& text) {
    display.show(share, text);
  };
  return prediction::predict(scenario, options);
}

Status write_prediction(const fs::path& folder,
                        const prediction::Predicted& predicted,
                        const nlohmann::json& document) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) return Error{ErrorCode::kIo, folder.string() + ": " + failure.message()};
  if (Status status = server::write_json(folder / "predict.json", document); !status) {
    return status;
  }
  const Result<std::string> page = prediction::page_of(predicted.prediction, predicted.ground);
  if (!page) return page.error();
  return server::write_whole(folder / "predict.html", *page);
}

int predict(const PredictArguments& arguments) {
  const Result<server::Scenario> scenario = load_to_predict(arguments);
  if (!scenario) return report(scenario.error());
  const auto predicted = predict_quietly_or_not(arguments, *scenario);
  if (!predicted) return report(predicted.error());
  for (const std::string& warning : predicted->prediction.warnings) {
    std::cerr << "warning: " << warning << "\n";
  }
  const nlohmann::json document = prediction::json_from(predicted->prediction);
  if (!arguments.out.empty()) {
    if (Status status = write_prediction(arguments.out, *predicted, document); !status) {
      return report(status.error());
    }
  }
  if (arguments.json) {
    std::cout << document.dump(2) << "\n";
    return kExitOk;
  }
  for (const std::string& sentence : prediction::sentences_of(predicted->prediction)) {
    std::cout << sentence << "\n";
  }
  if (!arguments.out.empty()) {
    std::cout << (fs::path(arguments.out) / "predict.html").string() << "\n";
  }
  return kExitOk;
}

}  // namespace

void add_predict_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<PredictArguments>();
  CLI::App* command = app.add_subcommand(
      "predict", "Predict where an estimator is lost, from imagery, elevation and mission");
  command->add_option("scenario", arguments->scenario, "Scenario file (JSON)")->required();
  command->add_option("--set", arguments->sets, "Override a field: path=value, e.g. seed=2")
      ->allow_extra_args(false);
  command->add_option("--out", arguments->out, "Folder for predict.json and predict.html");
  command->add_option("--camera", arguments->camera, "Camera of the scenario; default: its first");
  command->add_option("--rate", arguments->rate_hz, "Instants per second of the flight")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  command->add_option("--map-km", arguments->map_km, "Side of the map at most [km]")
      ->check(CLI::Range(0.1, 25.0))
      ->capture_default_str();
  command->add_option("--cell-m", arguments->cell_m, "Side of the map's cells [m]")
      ->check(CLI::Range(10.0, 10000.0))
      ->capture_default_str();
  command->add_flag("--no-map", arguments->no_map, "Only the flight");
  command->add_option("--jobs", arguments->jobs, "Threads; 0: one for each processor")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  add_file_limits(*command, arguments->files, "the scenario");
  command->add_option("--progress", arguments->progress, "File for the progress, as JSON");
  command->add_flag("--json", arguments->json, "Print JSON instead of sentences");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->callback([arguments, &exit_code] { exit_code = predict(*arguments); });
}

}  // namespace overfly::app
