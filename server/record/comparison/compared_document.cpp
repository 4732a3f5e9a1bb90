#include "server/record/comparison/compared_document.hpp"

#include <utility>

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// Parameters in the scenario lack the defaults that those in the manifest have.
void drop_parameters(Json& scenario) {
  const auto estimators = scenario.find("estimators");
  if (estimators == scenario.end() || !estimators->is_array()) return;
  for (Json& estimator : *estimators) {
    if (estimator.is_object()) estimator.erase("parameters");
  }
}

}  // namespace

Json compared_document(const RunManifest& run_manifest, Json scenario) {
  Json manifest = json_from(run_manifest);
  // What follows from the run, not what it was made of; the scenario has the fields of the cameras.
  for (const char* field : {"format_version",
                            "status",
                            "error",
                            "frames",
                            "frames_total",
                            "texture_limited",
                            "camera",
                            "cameras",
                            "epoch_utc_ns",
                            "duration_ns",
                            "estimators"}) {
    manifest.erase(field);
  }
  Json parameters = Json::object();
  for (const RunManifest::Estimator& estimator : run_manifest.estimators) {
    parameters[estimator.name] = estimator.parameters.value_or(RunManifest::Parameters{});
  }
  if (scenario.is_object()) drop_parameters(scenario);
  return {{"scenario", std::move(scenario)},
          {"parameters", std::move(parameters)},
          {"manifest", std::move(manifest)}};
}

}  // namespace overfly::server
