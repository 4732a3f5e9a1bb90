// Regular expressions, compiled once.
#pragma once

#include <string>

namespace overfly {

enum class LetterCase { kExact, kAny };

/// Whether the whole text matches a pattern of the program itself. The pattern is compiled at its
/// first use and kept. Thread-safe, whereas compiling patterns on several threads at the same time
/// is a data race in libstdc++ (the table of std::ctype<char>::narrow). Only this function's source
/// includes <regex>, which takes seconds to compile.
/// @pre the pattern is a valid ECMAScript expression
[[nodiscard]] bool matches_pattern(const std::string& text,
                                   const std::string& pattern,
                                   LetterCase letter_case = LetterCase::kExact);
/// The same for any part of the text.
[[nodiscard]] bool contains_pattern(const std::string& text, const std::string& pattern);

}  // namespace overfly
