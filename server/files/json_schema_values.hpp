// The keywords of JSON Schema that depend on a single value.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace overfly::server {

/// `type` is one of "object", "array", "string", "number", "integer", "boolean", "null".
/// A number without a fractional part is an integer, also if written as 2.0.
[[nodiscard]] bool has_type(const nlohmann::json& value, const std::string& type);

/// The requirement that a value violates ("in (0, 180)"), checked by type, const, enum, limits,
/// lengths, pattern and sizes; empty = valid.
[[nodiscard]] std::string broken_limit(const nlohmann::json& node, const nlohmann::json& value);

/// A value as shown in a message; long values are truncated.
[[nodiscard]] std::string shown(const nlohmann::json& value);
/// A path as shown in a message.
[[nodiscard]] std::string label_of(const std::string& path);

}  // namespace overfly::server
