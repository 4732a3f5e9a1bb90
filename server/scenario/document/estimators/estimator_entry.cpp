#include "server/scenario/document/estimators/estimator_entry.hpp"

#include <filesystem>
#include <utility>

#include "server/scenario/document/scenario_file.hpp"

namespace overfly::server {

Result<EstimatorSpec> estimator_from_json(nlohmann::json entry, const std::filesystem::path& base) {
  nlohmann::json document = {{"format_version", 1},
                             {"world", {{"builtin", nlohmann::json::object()}}},
                             {"flight", {{"course", nlohmann::json::object()}}},
                             {"estimators", nlohmann::json::array({std::move(entry)})}};
  Result<Scenario> scenario = resolve_scenario(std::move(document), {}, base);
  if (!scenario) return scenario.error();
  return std::move(scenario->estimators.front());
}

}  // namespace overfly::server
