// The schema of scenario documents (scenarios/scenario.schema.json).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace overfly::server {

/// Violations of the schema in a document: (JSON path, message). Empty = valid.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> schema_violations(
    const nlohmann::json& document);
/// The JSON schema (draft 2020-12) as text, embedded in the program.
[[nodiscard]] const std::string& scenario_schema_text();
/// Adds the schema's defaults. @pre the document is valid
void apply_schema_defaults(nlohmann::json& document);

}  // namespace overfly::server
