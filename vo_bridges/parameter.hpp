// Parameters of estimators, by the names their authors gave them.
#pragma once

#include <map>
#include <string>
#include <variant>

namespace overfly {

using ParameterValue = std::variant<bool, double, std::string>;
using VoParameters = std::map<std::string, ParameterValue>;

/// "true" or "false", the shortest text that reads back as the number (an exponent only beyond
/// 1e-9 and 2^53), or the text itself.
[[nodiscard]] std::string text_of(const ParameterValue& value);

}  // namespace overfly
