// Pieces that plots of all kinds consist of. Private to the plots.
#pragma once

#include <string>
#include <vector>

namespace overfly::server::plot {

/// `<svg ...>` with title and description for readers that do not see it.
[[nodiscard]] std::string svg_head(const std::string& id,
                                   const std::string& title,
                                   const std::string& description,
                                   double width_px,
                                   double height_px);

/// @param anchor  "start", "middle" or "end"
[[nodiscard]] std::string svg_text(double x,
                                   double y,
                                   const std::string& anchor,
                                   const std::string& css_class,
                                   const std::string& text);

[[nodiscard]] std::string svg_line(
    double x1, double y1, double x2, double y2, const std::string& css_class);

/// Width of a text in the plots' font, roughly [px].
[[nodiscard]] double text_width_px(const std::string& text);

/// A text cut to so many characters for a label.
[[nodiscard]] std::string label_text(const std::string& text, std::size_t most = 48);

/// Lines and labels from left to right, in as many rows as they need.
struct LegendEntry {
  std::string css_class;
  std::string label;
};
struct Legend {
  std::string markup;
  double height_px = 0.0;
};
[[nodiscard]] Legend legend_of(const std::vector<LegendEntry>& entries,
                               double left_px,
                               double right_px);

}  // namespace overfly::server::plot
