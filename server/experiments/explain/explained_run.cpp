#include "server/experiments/explain/explained_run.hpp"

#include <algorithm>
#include <optional>

#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using evaluation::Outcome;
using Json = nlohmann::json;

Error not_explainable(const fs::path& folder, const std::string& reason) {
  return {ErrorCode::kInvalidArgument, folder.string() + ": " + reason};
}

std::string known_names(const RunMetrics& metrics) {
  std::string names;
  for (const auto& [name, estimator] : metrics.estimators) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

/// The estimator to be explained.
Result<std::string> chosen_estimator(const RunMetrics& metrics,
                                     const Json& document,
                                     const std::string& wanted) {
  if (metrics.estimators.contains(wanted)) return wanted;
  if (!wanted.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "estimator = " + wanted + ": must be one of " + known_names(metrics)};
  }
  std::optional<std::string> first;
  for (const Json& entry : document.at("estimators")) {
    const std::string name = entry.at("name").get<std::string>();
    const auto found = metrics.estimators.find(name);
    if (found == metrics.estimators.end()) continue;
    if (!first) first = name;
    if (found->second.score.outcome != Outcome::kCompleted) return name;
  }
  if (first) return *first;
  return Error{ErrorCode::kInvalidArgument, "the run has no estimator"};
}

bool has_recorded_images(const Json& document) {
  const auto recorded = [](const Json& camera) { return camera.contains("images"); };
  if (document.contains("camera")) return recorded(document.at("camera"));
  const Json cameras = document.value("cameras", Json::array());
  return std::any_of(cameras.begin(), cameras.end(), recorded);
}

}  // namespace

Result<ExplainedRun> read_explained_run(const fs::path& run_folder,
                                        const std::string& estimator,
                                        const SourcePolicy& sources) {
  const fs::path folder = fs::absolute(run_folder).lexically_normal();
  const Result<RunInfo> info = read_run_info(folder);
  if (!info) return info.error();
  if (info->status != RunStatus::kCompleted) {
    return not_explainable(
        folder, std::string("status = ") + to_string(info->status) + ": must be completed");
  }
  const Result<RunMetrics> metrics = read_run_metrics(folder);
  if (!metrics) return metrics.error();
  const Result<Scenario> scenario = load_scenario(scenario_file(folder), {}, sources);
  if (!scenario) return scenario.error();
  const Json& document = scenario->resolved;
  if (has_recorded_images(document)) {
    return not_explainable(folder, "recorded images cannot be taken again without a disturbance");
  }
  const Result<std::string> name = chosen_estimator(*metrics, document, estimator);
  if (!name) return not_explainable(folder, name.error().message);

  ExplainedRun run{
      folder, info->id, info->title, document, *name, 0, metrics->flight.duration_s, {}};
  run.score = metrics->estimators.at(*name).score;
  const Json& entries = document.at("estimators");
  while (entries.at(run.estimator).at("name") != *name) ++run.estimator;
  return run;
}

}  // namespace overfly::server::experiments
