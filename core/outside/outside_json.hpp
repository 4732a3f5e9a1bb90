// Parses JSON from outside the program: network messages, options and files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace overfly {

/// Maximum nesting of arrays and objects. Overfly's documents need at most a dozen levels; the
/// limit prevents a stack overflow in recursive code (copies, destructors, schema checks).
inline constexpr std::size_t kMaxJsonDepth = 64;

/// Checks the nesting depth by counting brackets outside strings, before a document is built.
/// Errors: kUnreadable "ORIGIN: is nested more than 64 deep".
[[nodiscard]] Status check_json_depth(std::string_view text, const std::string& origin);

/// Converts a parser's error at a byte offset (from 1) into "ORIGIN, line 3, column 7: REASON".
/// Long reasons are cut.
[[nodiscard]] Error json_syntax_error(std::string_view text,
                                      std::size_t byte,
                                      const std::string& complaint,
                                      const std::string& origin);

/// Parses JSON from outside. The nesting depth is checked first, and no exception is thrown. A key
/// that an object has twice is an error: one of the values would be lost.
/// @tparam Json  nlohmann::json or nlohmann::ordered_json. The parser is compiled once for each of
/// the two, because it takes the compiler a second in every file that uses it.
/// @param origin  names the source in messages: a file, "the body"
/// Errors: kUnreadable naming origin, line and column, or origin and depth limit, or the key's
/// path.
template <typename Json>
[[nodiscard]] Result<Json> json_from_outside(std::string_view text, const std::string& origin);

}  // namespace overfly
