#include "vo_bridges/estimator_text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace overfly {

namespace {

/// Number of bytes of the UTF-8 character at the start of `text`; 0 if it is invalid.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  std::size_t length = 0;
  std::uint32_t code = 0;
  if (byte(0) < 0x80) return byte(0) >= 0x20 && byte(0) != 0x7F ? 1 : 0;
  if ((byte(0) & 0xE0U) == 0xC0U) length = 2, code = byte(0) & 0x1FU;
  if ((byte(0) & 0xF0U) == 0xE0U) length = 3, code = byte(0) & 0x0FU;
  if ((byte(0) & 0xF8U) == 0xF0U) length = 4, code = byte(0) & 0x07U;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  constexpr std::array<std::uint32_t, 5> kSmallest = {0, 0, 0xA0, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < kSmallest[length] || code > 0x10FFFF || surrogate ? 0 : length;
}

/// Number of bytes of the control sequence of a terminal at the start of `text`, such as a colour
/// (ECMA-48, 5.4: ESC [, parameters, intermediate bytes, a final byte); 0 if there is none.
std::size_t control_sequence_length(std::string_view text) {
  if (!text.starts_with("\x1B[")) return 0;
  std::size_t end = 2;
  const auto in = [&](char low, char high) {
    return end < text.size() && text[end] >= low && text[end] <= high;
  };
  while (in('\x30', '\x3F')) ++end;
  while (in('\x20', '\x2F')) ++end;
  return in('\x40', '\x7E') ? end + 1 : 0;
}

}  // namespace

std::string printable(std::string_view text, std::size_t limit) {
  std::string clean;
  while (!text.empty()) {
    if (const std::size_t control = control_sequence_length(text); control > 0) {
      text.remove_prefix(control);
      continue;
    }
    const std::size_t length = utf8_length(text);
    if (clean.size() + std::max<std::size_t>(length, 1) > limit) break;
    if (length == 0) {
      clean += text.front() == '\t' ? ' ' : '?';
    } else {
      clean += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return clean;
}

bool is_figure_name(std::string_view name) {
  return !name.empty() && name.size() <= kNameLimitBytes &&
         std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
}

}  // namespace overfly
