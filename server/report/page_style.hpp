// The look of a report: its style sheet and the colours of its series.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace overfly::server::report {

/// Colours as "#rrggbb". Series differ by hue for all common kinds of colour vision (the first
/// colours of Okabe and Ito 2008, "Color universal design", as far as their contrast allows) and by
/// their dashes.
struct Theme {
  std::string_view page;
  std::string_view text;
  std::string_view muted;  ///< text of less weight
  std::string_view grid;
  std::string_view box;  ///< behind tables' heads and code
  std::string_view link;
  std::string_view error;    ///< text
  std::string_view caution;  ///< text
  std::string_view truth;
  std::array<std::string_view, 4> series;
  std::string_view tracking;  ///< bands
  std::string_view initialising;
  std::string_view lost;
};

inline constexpr Theme kLightTheme{"#ffffff",
                                   "#1b1f24",
                                   "#57606a",
                                   "#e3e6ea",
                                   "#f3f5f7",
                                   "#005a9c",
                                   "#b42318",
                                   "#7a4d00",
                                   "#000000",
                                   {"#0072b2", "#d55e00", "#009e73", "#c2609a"},
                                   "#009e73",
                                   "#767676",
                                   "#d55e00"};
inline constexpr Theme kDarkTheme{"#15181c",
                                  "#e6e9ed",
                                  "#a9b1ba",
                                  "#2b3138",
                                  "#1f242a",
                                  "#7cc0f5",
                                  "#ff9d90",
                                  "#f0c060",
                                  "#ffffff",
                                  {"#4a9fe0", "#e8702a", "#1db587", "#d98abb"},
                                  "#1db587",
                                  "#8d949b",
                                  "#e8702a"};

/// For on screen by the reader's preferred theme, and the light one on paper.
[[nodiscard]] std::string style_sheet();

}  // namespace overfly::server::report
