// The part of JSON Schema (draft 2020-12) that Overfly's schemas use: type, const, enum,
// properties, required, additionalProperties, minProperties, dependentRequired, items, minItems,
// maxItems, minimum, maximum, exclusiveMinimum, exclusiveMaximum, minLength, maxLength, pattern,
// oneOf, $ref into $defs. A validator of the full standard gives the same verdicts.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace overfly::server {

/// One violation of the schema in a document.
struct SchemaViolation {
  std::string path;  ///< dotted: "estimators.0.name"; empty = the whole document
  std::string text;  ///< "estimators.0.name = 7: must be text"
};

class JsonSchema {
 public:
  /// @pre `schema` uses only the keywords above and annotations, and every $ref resolves
  explicit JsonSchema(nlohmann::json schema) : schema_(std::move(schema)) {}

  /// Empty = valid.
  [[nodiscard]] std::vector<SchemaViolation> violations(const nlohmann::json& document) const;
  /// Adds each absent property that has a `default`, also inside objects added this way.
  void apply_defaults(nlohmann::json& document) const;
  /// Keywords of the schema that are neither implemented here nor annotations; used to test the
  /// schema.
  [[nodiscard]] std::vector<std::string> unknown_keywords() const;

 private:
  [[nodiscard]] const nlohmann::json& resolved(const nlohmann::json& node) const;
  void check(const nlohmann::json& node,
             const nlohmann::json& value,
             const std::string& path,
             std::vector<SchemaViolation>& violations) const;
  void check_object(const nlohmann::json& node,
                    const nlohmann::json& value,
                    const std::string& path,
                    std::vector<SchemaViolation>& violations) const;
  void check_array(const nlohmann::json& node,
                   const nlohmann::json& value,
                   const std::string& path,
                   std::vector<SchemaViolation>& violations) const;
  void check_one_of(const nlohmann::json& node,
                    const nlohmann::json& value,
                    const std::string& path,
                    std::vector<SchemaViolation>& violations) const;
  /// Names the fields of a value that no branch of its `oneOf` has; empty if there are none.
  [[nodiscard]] std::string unknown_text(const nlohmann::json& branches,
                                         const nlohmann::json& value) const;
  [[nodiscard]] bool matches(const nlohmann::json& node, const nlohmann::json& value) const;
  [[nodiscard]] bool looks_meant(const nlohmann::json& branch, const nlohmann::json& value) const;
  void apply_defaults(const nlohmann::json& node, nlohmann::json& value) const;

  nlohmann::json schema_;
};

}  // namespace overfly::server
