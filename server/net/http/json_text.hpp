// Serialises JSON without throwing, and parses JSON objects strictly.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "core/result.hpp"

namespace overfly::net {

/// Compact text; bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string to_text(const nlohmann::json& json);

/// Errors: kInvalidArgument if it is not a JSON object, naming `what` was expected.
[[nodiscard]] Result<nlohmann::json> parse_object(const std::string& text, const std::string& what);

/// Reads the fields of a JSON object one by one. Keeps the first error; a field that was never read
/// or allowed is an error too. Call finish() after reading all fields.
class JsonFields {
 public:
  /// @param where  prefix of field names in messages, e.g. "speed"; may be empty
  JsonFields(const nlohmann::json& object, std::string where);

  /// Each is empty if the field is absent, has another type or lies outside [min, max].
  std::optional<std::string> text(const std::string& name);
  std::optional<double> number(const std::string& name, double min, double max);
  std::optional<std::int64_t> integer(const std::string& name, std::int64_t min, std::int64_t max);
  std::optional<bool> boolean(const std::string& name);
  /// Null if absent.
  const nlohmann::json* object(const std::string& name);
  const nlohmann::json* array(const std::string& name);
  /// Marks a field as known without reading it.
  void allow(const std::string& name) { known_.insert(name); }

  /// Makes an absent field an error.
  void require(const std::string& name);
  /// @param message  follows the field's name: ": must be ..." or " = 3: must be ..."
  void reject(const std::string& name, const std::string& message);
  /// Errors: kInvalidArgument "where.field = value: must be limit".
  [[nodiscard]] Status finish();

 private:
  const nlohmann::json* find(const std::string& name);
  void reject_value(const std::string& name, const std::string& limit);
  [[nodiscard]] std::string full_name(const std::string& name) const;

  const nlohmann::json& object_;
  std::string where_;
  std::set<std::string> known_;
  std::optional<Error> error_;
};

}  // namespace overfly::net
