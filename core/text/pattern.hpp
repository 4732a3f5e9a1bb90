// Regular expressions, compiled once.
#pragma once

#include <regex>
#include <string>

namespace overfly {

/// A pattern of the program itself, compiled at its first use and kept. Thread-safe, whereas
/// compiling patterns on several threads at the same time is a data race in libstdc++ (the table of
/// std::ctype<char>::narrow).
/// @pre the pattern is a valid ECMAScript expression
[[nodiscard]] const std::regex& compiled_pattern(
    const std::string& pattern, std::regex::flag_type flags = std::regex::ECMAScript);

}  // namespace overfly
