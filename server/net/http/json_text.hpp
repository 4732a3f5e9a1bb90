// JSON out as text that never throws, and JSON in that tolerates nothing unknown.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "core/result.hpp"

namespace overfly::net {

/// Compact text; bytes that are no UTF-8 become U+FFFD.
[[nodiscard]] std::string to_text(const nlohmann::json& json);

/// Errors: kInvalidArgument when it is no JSON object, naming `what` it should have been.
[[nodiscard]] Result<nlohmann::json> parse_object(const std::string& text, const std::string& what);

/// Reads the fields of a JSON object one by one. The first fault is kept, and a field that nobody
/// asked for is one; ask finish() once all are read.
class JsonFields {
 public:
  /// @param where  prefix of the fields' names in messages, e.g. "speed"; may be empty
  JsonFields(const nlohmann::json& object, std::string where);

  /// Each is empty when the field is absent, has another type or lies outside [min, max].
  std::optional<std::string> text(const std::string& name);
  std::optional<double> number(const std::string& name, double min, double max);
  std::optional<std::int64_t> integer(const std::string& name, std::int64_t min, std::int64_t max);
  std::optional<bool> boolean(const std::string& name);
  /// Null when absent.
  const nlohmann::json* object(const std::string& name);
  const nlohmann::json* array(const std::string& name);
  /// Marks a field as known without reading it.
  void allow(const std::string& name) { known_.insert(name); }

  /// Makes an absent field a fault.
  void require(const std::string& name);
  void fault(const std::string& name, const std::string& message);
  /// Errors: kInvalidArgument "where.field = value: must be limit".
  [[nodiscard]] Status finish();

 private:
  const nlohmann::json* find(const std::string& name);
  void fault_value(const std::string& name, const std::string& limit);
  [[nodiscard]] std::string full_name(const std::string& name) const;

  const nlohmann::json& object_;
  std::string where_;
  std::set<std::string> known_;
  std::optional<Error> fault_;
};

}  // namespace overfly::net
