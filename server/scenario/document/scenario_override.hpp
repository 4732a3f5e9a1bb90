// Applies overrides to a scenario document.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// "path=VALUE": VALUE is parsed as JSON, else taken as a string. Errors: kInvalidArgument; also
/// for a VALUE that starts as a JSON object or array and is not one.
[[nodiscard]] Result<Override> parse_override(const std::string& text);
[[nodiscard]] Result<std::vector<Override>> parse_overrides(const std::vector<std::string>& texts);

/// Sets the value at a dotted path and creates the objects and arrays on the way. A number selects
/// an element of an array; the array's length appends one. Setting `world.builtin...` in a document
/// whose world is of another kind replaces that world; likewise for `flight`. Setting the whole of
/// `camera` or `cameras` removes the other.
/// Errors: kInvalidArgument naming the part of the path that does not fit the document.
[[nodiscard]] Status apply_override(const Override& change, nlohmann::json& document);

}  // namespace overfly::server
