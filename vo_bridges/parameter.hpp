// Parameters of estimators, with the names used by their authors.
#pragma once

#include <map>
#include <string>
#include <variant>

namespace overfly {

using ParameterValue = std::variant<bool, double, std::string>;
using VoParameters = std::map<std::string, ParameterValue>;

/// Converts a value to text: "true" or "false", the shortest decimal that reads back as the same
/// number (with an exponent only below 1e-9 or above 2^53), or the text itself.
[[nodiscard]] std::string text_of(const ParameterValue& value);

}  // namespace overfly
