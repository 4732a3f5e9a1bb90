#include "server/scenario/document/scenario_schema.hpp"

#include "server/files/json_schema.hpp"

namespace overfly::engine {
namespace {

using Json = nlohmann::json;

const JsonSchema& schema() {
  static const JsonSchema instance(Json::parse(scenario_schema_text()));
  return instance;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> schema_faults(const Json& document) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (SchemaFault& fault : schema().faults(document)) {
    pairs.emplace_back(std::move(fault.path), std::move(fault.text));
  }
  return pairs;
}

void apply_schema_defaults(Json& document) { schema().apply_defaults(document); }

}  // namespace overfly::engine
