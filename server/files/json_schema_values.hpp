// The keywords of JSON Schema that look at one value alone.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace overfly::engine {

/// `type` is one of "object", "array", "string", "number", "integer", "boolean", "null".
/// A number without a fractional part is an integer, however it is written (2.0).
[[nodiscard]] bool has_type(const nlohmann::json& value, const std::string& type);

/// What a value must be and is not ("in (0, 180)"), by type, const, enum, limits, lengths, pattern
/// and sizes; empty = it is.
[[nodiscard]] std::string broken_limit(const nlohmann::json& node, const nlohmann::json& value);

/// A value as a message shows it, cut where it is long.
[[nodiscard]] std::string shown(const nlohmann::json& value);
/// A path as a message shows it.
[[nodiscard]] std::string label_of(const std::string& path);

}  // namespace overfly::engine
