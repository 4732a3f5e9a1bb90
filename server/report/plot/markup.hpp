// Text from outside as part of an HTML or SVG document.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace overfly::server::plot {

/// Longer texts are cut, with an ellipsis.
inline constexpr std::size_t kMaxTextBytes = 4000;

/// Valid UTF-8 that shows what it contains: U+FFFD replaces bytes that are no UTF-8 (RFC 3629),
/// control characters but line feed and tabulator, characters that change the direction of the text
/// around them (they can make a text read as another one) and noncharacters.
/// @param max_bytes  of the input that is shown; the cut never splits a character
[[nodiscard]] std::string clean_text(std::string_view text, std::size_t max_bytes = kMaxTextBytes);

/// clean_text for element content and for quoted attributes: & < > " ' are character references.
[[nodiscard]] std::string escaped(std::string_view text, std::size_t max_bytes = kMaxTextBytes);

/// Standard alphabet with padding (RFC 4648, section 4), for data URIs.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

/// A number as an attribute: fixed, without trailing zeros and never "-0"; "0" if it is not finite.
/// @param decimals  in [0, 9]
[[nodiscard]] std::string attribute_number(double value, int decimals = 1);

}  // namespace overfly::server::plot
