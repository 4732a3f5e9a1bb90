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
  std::map<std::string, std::string> query;  ///< decoded; the last one of equal names stays
};

/// Empty for a target that is no absolute path, or has a broken percent escape or a NUL.
/// Segments are split before they are decoded: "%2F" stays inside its segment.
[[nodiscard]] std::optional<Url> parse_target(std::string_view target);

/// Takes a parameter out of a target's query. @return its decoded value, the last one of several;
/// "" for a broken escape. Empty when it is not there.
[[nodiscard]] std::optional<std::string> take_query_parameter(std::string* target,
                                                              std::string_view name);

/// Decodes %XX, and '+' as a space where wanted. Empty for a broken escape or a NUL.
[[nodiscard]] std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space);

}  // namespace overfly::net
