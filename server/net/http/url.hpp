// Request targets: path segments and query, percent-decoded.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace overfly::net {

struct Url {
  std::vector<std::string> segments;         ///< decoded; "/" has none, "/a/" has "a" and ""
  std::map<std::string, std::string> query;  ///< decoded; the last one of equal names is kept
  std::optional<std::string> repeated{};     ///< a name that occurs several times in the query
};

/// Empty for a target that is not an absolute path, or has an invalid percent escape or a NUL.
/// Segments are split before they are decoded: "%2F" stays inside its segment.
[[nodiscard]] std::optional<Url> parse_target(std::string_view target);

/// Removes a parameter from a target's query.
/// @return its decoded value, the last one of several; "" for an invalid escape; empty if it is
/// absent
[[nodiscard]] std::optional<std::string> take_query_parameter(std::string* target,
                                                              std::string_view name);

/// Decodes %XX, and optionally '+' as a space. Empty for an invalid escape or a NUL.
[[nodiscard]] std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space);

}  // namespace overfly::net
