// The part of JSON Schema (draft 2020-12) that our schemas use: type, const, enum, properties,
// required, additionalProperties, minProperties, dependentRequired, items, minItems, maxItems,
// minimum, maximum, exclusiveMinimum, exclusiveMaximum, minLength, maxLength, pattern, oneOf,
// $ref into $defs. Any validator of the full standard gives the same verdicts.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace overfly::engine {

/// One place where a document breaks its schema.
struct SchemaFault {
  std::string path;  ///< dotted: "estimators.0.name"; empty = the whole document
  std::string text;  ///< "estimators.0.name = 7: must be text"
};

class JsonSchema {
 public:
  /// @pre `schema` uses no keyword beyond those above and annotations, and no dangling $ref.
  explicit JsonSchema(nlohmann::json schema) : schema_(std::move(schema)) {}

  /// Empty = valid.
  [[nodiscard]] std::vector<SchemaFault> faults(const nlohmann::json& document) const;
  /// Fills in each absent property that has a `default`, also inside what is filled in.
  /// @pre faults(document) is empty
  void apply_defaults(nlohmann::json& document) const;
  /// Keywords in the schema that neither validate here nor annotate; for a test of the schema.
  [[nodiscard]] std::vector<std::string> unknown_keywords() const;

 private:
  [[nodiscard]] const nlohmann::json& resolved(const nlohmann::json& node) const;
  void check(const nlohmann::json& node,
             const nlohmann::json& value,
             const std::string& path,
             std::vector<SchemaFault>& faults) const;
  void check_object(const nlohmann::json& node,
                    const nlohmann::json& value,
                    const std::string& path,
                    std::vector<SchemaFault>& faults) const;
  void check_array(const nlohmann::json& node,
                   const nlohmann::json& value,
                   const std::string& path,
                   std::vector<SchemaFault>& faults) const;
  void check_one_of(const nlohmann::json& node,
                    const nlohmann::json& value,
                    const std::string& path,
                    std::vector<SchemaFault>& faults) const;
  [[nodiscard]] bool matches(const nlohmann::json& node, const nlohmann::json& value) const;
  [[nodiscard]] bool looks_meant(const nlohmann::json& branch, const nlohmann::json& value) const;
  void apply_defaults(const nlohmann::json& node, nlohmann::json& value) const;

  nlohmann::json schema_;
};

}  // namespace overfly::engine
