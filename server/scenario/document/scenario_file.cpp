#include "server/scenario/document/scenario_file.hpp"

#include <algorithm>
#include <utility>

#include "core/outside/outside_json.hpp"
#include "server/files/whole_file.hpp"
#include "server/scenario/document/scenario_calibration.hpp"
#include "server/scenario/document/scenario_document.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "server/scenario/document/scenario_schema.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Converts a file's name to a scenario name; invalid characters become `_`.
std::string name_from(std::string text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  constexpr std::size_t kLongest = 64;
  text = text.substr(0, kLongest);
  for (char& c : text) {
    if (!allowed(c) && c != '-') c = '_';
  }
  if (text.empty() || !allowed(text.front())) text = "scenario" + text.substr(0, kLongest - 8);
  return text;
}

/// Adds the file's name to a document without a name, so that a run's copy of it still shows its
/// origin.
void put_name(Json& document, const std::string& name) {
  if (!document.is_object()) return;
  if (!document.contains("name")) document["name"] = name;
}

/// Recursion ends at the limit.
bool is_deeper_than(const Json& value, std::size_t limit) {
  if (!value.is_structured()) return false;
  return limit == 0 || std::any_of(value.begin(), value.end(), [&](const Json& child) {
           return is_deeper_than(child, limit - 1);
         });
}

Status check_schema(const Json& document) {
  std::string messages;
  for (const auto& [path, text] : schema_violations(document)) {
    messages += (messages.empty() ? "" : "\n") + text;
  }
  if (messages.empty()) return {};
  return Error{ErrorCode::kInvalidArgument, messages};
}

}  // namespace

Result<Scenario> resolve_scenario(Json document,
                                  const std::vector<Override>& overrides,
                                  const fs::path& base,
                                  const SourcePolicy& sources) {
  for (const Override& change : overrides) {
    if (Status status = apply_override(change, document); !status) return status.error();
  }
  // A value within the limit, at a path within the limit, may exceed the limit together.
  if (is_deeper_than(document, kMaxJsonDepth)) {
    return Error{ErrorCode::kInvalidArgument,
                 "the scenario is nested more than " + std::to_string(kMaxJsonDepth) + " deep"};
  }
  if (Status status = check_schema(document); !status) return status.error();
  put_name(document, "scenario");
  if (!document.contains("cameras")) document.emplace("camera", Json::object());
  if (Status status = read_calibrations(document, base, sources); !status) return status.error();
  // A file's camera must meet the limits of one in the document.
  if (Status status = check_schema(document); !status) return status.error();
  apply_schema_defaults(document);
  return scenario_from(std::move(document), base);
}

Result<Scenario> load_scenario(const fs::path& file,
                               const std::vector<Override>& overrides,
                               const SourcePolicy& sources) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 20U;
  Result<Json> document = read_json(file, kMaxBytes);
  if (!document) return document.error();
  put_name(*document, name_from(file.stem().string()));
  const fs::path folder = fs::absolute(file).parent_path().lexically_normal();
  Result<Scenario> scenario = resolve_scenario(std::move(*document), overrides, folder, sources);
  if (!scenario) return scenario.error().in(file.string());
  return scenario;
}

}  // namespace overfly::server
