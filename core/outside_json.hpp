// JSON that comes from outside the program: the wire, options, and files of any kind.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace overfly {

/// Arrays and objects inside each other. No document of ours needs more than a dozen; the limit
/// keeps what walks a document recursively (a copy, a destructor, a schema) off the stack's end.
inline constexpr std::size_t kMaxJsonDepth = 64;

/// Counts brackets outside of strings, before any document is built.
/// Errors: kUnreadable "ORIGIN: is nested more than 64 deep".
[[nodiscard]] Status check_json_depth(std::string_view text, const std::string& origin);

/// "ORIGIN, line 3, column 7: REASON" of a parser's complaint at a byte (from 1), cut to a length
/// that can be shown.
[[nodiscard]] Error json_syntax_error(std::string_view text,
                                      std::size_t byte,
                                      const std::string& complaint,
                                      const std::string& origin);

/// The one way in for JSON from outside: its depth is checked before it is parsed, and no exception
/// leaves.
/// @tparam Json  nlohmann::json or nlohmann::ordered_json; named by the caller, so that this room
///               needs no JSON library
/// @param origin  names the source in messages: a file, "the body"
/// Errors: kUnreadable naming origin, line and column, or origin and depth limit.
template <typename Json>
[[nodiscard]] Result<Json> json_from_outside(std::string_view text, const std::string& origin) {
  if (Status status = check_json_depth(text, origin); !status) return status.error();
  try {
    return Json::parse(text);
  } catch (const typename Json::parse_error& error) {
    return json_syntax_error(text, error.byte, error.what(), origin);
  } catch (const typename Json::exception& error) {
    // A number beyond any double, for one.
    return Error{ErrorCode::kUnreadable, origin + ": " + error.what()};
  }
}

}  // namespace overfly
