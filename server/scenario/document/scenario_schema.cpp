#include "server/scenario/document/scenario_schema.hpp"

#include "core/outside/outside_json.hpp"
#include "server/files/json_schema.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

const JsonSchema& schema() {
  static const JsonSchema instance(
      json_from_outside<Json>(scenario_schema_text(), "the scenarios' schema").value());
  return instance;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> schema_violations(const Json& document) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (SchemaViolation& violation : schema().violations(document)) {
    pairs.emplace_back(std::move(violation.path), std::move(violation.text));
  }
  return pairs;
}

void apply_schema_defaults(Json& document) { schema().apply_defaults(document); }

}  // namespace overfly::server
