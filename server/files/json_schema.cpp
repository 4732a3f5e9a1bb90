#include "server/files/json_schema.hpp"

#include <algorithm>
#include <set>

#include "server/files/json_schema_values.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;
using Violations = std::vector<SchemaViolation>;

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

SchemaViolation missing(const std::string& path, const std::string& why = "must be given") {
  return {path, path + ": " + why};
}

std::string names_of(const Json& properties) {
  std::string names;
  for (const auto& [name, unused] : properties.items()) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names.empty() ? "none" : names;
}

/// A field whose last words equal the given name: "datum" probably meant "vertical_datum".
std::string suggestion(const std::string& given, const Json& properties) {
  for (const auto& [name, value] : properties.items()) {
    if (name.ends_with("_" + given)) return "; did you mean " + name + "?";
  }
  return "";
}

/// What a branch of `oneOf` wants, for people.
std::string title_of(const Json& branch) {
  if (branch.contains("title")) return branch.at("title").get<std::string>();
  if (!branch.contains("required")) return branch.value("type", "another value");
  std::string names;
  for (const Json& name : branch.at("required")) {
    names += (names.empty() ? "" : ", ") + name.get<std::string>();
  }
  return "{" + names + "}";
}

/// The value of a keyword, or an empty object (`.items()` must not iterate over a temporary).
const Json& keyword(const Json& node, const char* name) {
  static const Json none = Json::object();
  return node.contains(name) ? node.at(name) : none;
}

void collect_keywords(const Json& node, std::set<std::string>& keywords) {
  if (!node.is_object()) return;
  for (const auto& [key, value] : node.items()) {
    keywords.insert(key);
    if (key == "properties" || key == "$defs") {
      for (const auto& [name, child] : value.items()) collect_keywords(child, keywords);
    } else if (key == "oneOf") {
      for (const Json& branch : value) collect_keywords(branch, keywords);
    } else if (key == "items" || key == "additionalProperties") {
      collect_keywords(value, keywords);
    }
  }
}

}  // namespace

std::vector<std::string> JsonSchema::unknown_keywords() const {
  static const std::set<std::string> known = {"type",
                                              "const",
                                              "enum",
                                              "properties",
                                              "required",
                                              "items",
                                              "minItems",
                                              "maxItems",
                                              "additionalProperties",
                                              "minProperties",
                                              "maxProperties",
                                              "minimum",
                                              "maximum",
                                              "minLength",
                                              "exclusiveMinimum",
                                              "exclusiveMaximum",
                                              "maxLength",
                                              "pattern",
                                              "oneOf",
                                              "dependentRequired",
                                              "$ref",
                                              "$defs",
                                              "$schema",
                                              "$id",
                                              "title",
                                              "description",
                                              "default"};
  std::set<std::string> used;
  collect_keywords(schema_, used);
  std::vector<std::string> unknown;
  std::set_difference(
      used.begin(), used.end(), known.begin(), known.end(), std::back_inserter(unknown));
  return unknown;
}

const Json& JsonSchema::resolved(const Json& node) const {
  if (!node.contains("$ref")) return node;
  const std::string ref = node.at("$ref").get<std::string>();
  return resolved(schema_.at(Json::json_pointer(ref.substr(1))));
}

Violations JsonSchema::violations(const Json& document) const {
  Violations violations;
  check(schema_, document, "", violations);
  return violations;
}

bool JsonSchema::matches(const Json& node, const Json& value) const {
  Violations violations;
  check(node, value, "", violations);
  return violations.empty();
}

void JsonSchema::check(const Json& unresolved,
                       const Json& value,
                       const std::string& path,
                       Violations& violations) const {
  const Json& node = resolved(unresolved);
  if (std::string limit = broken_limit(node, value); !limit.empty()) {
    violations.push_back({path, label_of(path) + " = " + shown(value) + ": must be " + limit});
    return;
  }
  if (value.is_object()) check_object(node, value, path, violations);
  if (value.is_array()) check_array(node, value, path, violations);
  if (node.contains("oneOf")) check_one_of(node, value, path, violations);
}

void JsonSchema::check_object(const Json& node,
                              const Json& value,
                              const std::string& path,
                              Violations& violations) const {
  const Json& properties = keyword(node, "properties");
  for (const auto& [key, child] : properties.items()) {
    if (value.contains(key)) check(child, value.at(key), joined(path, key), violations);
  }
  for (const Json& key : keyword(node, "required")) {
    const std::string name = key.get<std::string>();
    if (!value.contains(name)) violations.push_back(missing(joined(path, name)));
  }
  for (const auto& [given, wanted] : keyword(node, "dependentRequired").items()) {
    if (!value.contains(given)) continue;
    for (const Json& key : wanted) {
      const std::string name = key.get<std::string>();
      if (value.contains(name)) continue;
      violations.push_back(
          missing(joined(path, name), "must be given with " + joined(path, given)));
    }
  }
  if (!node.contains("additionalProperties")) return;
  const Json& additional = node.at("additionalProperties");
  for (const auto& [key, child] : value.items()) {
    if (properties.contains(key)) continue;
    const std::string where = joined(path, key);
    if (additional.is_object()) {
      check(additional, child, where, violations);
    } else if (additional == false) {
      violations.push_back({where,
                            where + " = " + shown(child) + ": no such field" +
                                suggestion(key, properties) + " (known: " + names_of(properties) +
                                ")"});
    }
  }
}

void JsonSchema::check_array(const Json& node,
                             const Json& value,
                             const std::string& path,
                             Violations& violations) const {
  if (!node.contains("items")) return;
  for (std::size_t i = 0; i < value.size(); ++i) {
    check(node.at("items"), value[i], joined(path, std::to_string(i)), violations);
  }
}

bool JsonSchema::looks_meant(const Json& branch, const Json& value) const {
  const Json& node = resolved(branch);
  if (node.contains("type") && !has_type(value, node.at("type"))) return false;
  if (node.contains("const") || node.contains("enum")) return false;
  const Json& required = keyword(node, "required");
  return std::all_of(required.begin(), required.end(), [&](const Json& key) {
    return value.contains(key.get<std::string>());
  });
}

void JsonSchema::check_one_of(const Json& node,
                              const Json& value,
                              const std::string& path,
                              Violations& violations) const {
  const Json& branches = node.at("oneOf");
  const auto fits = std::count_if(
      branches.begin(), branches.end(), [&](const Json& branch) { return matches(branch, value); });
  if (fits == 1) return;
  // The errors of the branch that was probably meant are more useful than "none fits".
  std::vector<const Json*> meant;
  std::string titles;
  for (const Json& branch : branches) {
    if (looks_meant(branch, value)) meant.push_back(&branch);
    titles += (titles.empty() ? "" : ", ") + title_of(resolved(branch));
  }
  if (fits == 0 && meant.size() == 1) {
    check(*meant.front(), value, path, violations);
    return;
  }
  violations.push_back({path,
                        label_of(path) + " = " + shown(value) + ": must be exactly one of " +
                            titles + unknown_text(branches, value)});
}

std::string JsonSchema::unknown_text(const Json& branches, const Json& value) const {
  if (!value.is_object()) return "";
  std::string names;
  for (const auto& [key, unused] : value.items()) {
    const bool known = std::any_of(branches.begin(), branches.end(), [&](const Json& branch) {
      return keyword(resolved(branch), "properties").contains(key);
    });
    if (!known) names += (names.empty() ? "" : ", ") + key;
  }
  return names.empty() ? "" : " (unknown: " + names + ")";
}

void JsonSchema::apply_defaults(Json& document) const { apply_defaults(schema_, document); }

void JsonSchema::apply_defaults(const Json& unresolved, Json& value) const {
  const Json& node = resolved(unresolved);
  if (value.is_object()) {
    for (const auto& [key, child] : keyword(node, "properties").items()) {
      // A default next to a $ref takes precedence over that of the referenced schema.
      const Json& property = child.contains("default") ? child : resolved(child);
      if (!value.contains(key) && property.contains("default")) value[key] = property.at("default");
      if (value.contains(key)) apply_defaults(child, value[key]);
    }
  }
  if (value.is_array() && node.contains("items")) {
    for (Json& item : value) apply_defaults(node.at("items"), item);
  }
  for (const Json& branch : keyword(node, "oneOf")) {
    if (!matches(branch, value)) continue;
    apply_defaults(branch, value);
    break;
  }
}

}  // namespace overfly::server
