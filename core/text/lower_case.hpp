#pragma once

#include <string>

namespace overfly {

/// Converts the letters A to Z to lower case, independent of the locale.
[[nodiscard]] inline std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

}  // namespace overfly
