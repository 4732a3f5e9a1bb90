// Words in the names of ROS frames. Private to ros.
#pragma once

#include <string_view>

namespace overfly::flight::logs {

/// Whether the last word of a frame's name is `word`: "ned", "odom_ned" and "a/ned" end with the
/// word "ned", "gravity_aligned" does not. Words have letters and digits.
[[nodiscard]] constexpr bool ends_with_word(std::string_view name, std::string_view word) {
  if (!name.ends_with(word)) return false;
  name.remove_suffix(word.size());
  if (name.empty()) return true;
  const char before = name.back();
  const bool continues = (before >= 'a' && before <= 'z') || (before >= 'A' && before <= 'Z') ||
                         (before >= '0' && before <= '9');
  return !continues;
}

}  // namespace overfly::flight::logs
