#include "server/report/plot/svg_parts.hpp"

#include "server/report/plot/markup.hpp"

namespace overfly::server::plot {
namespace {

constexpr double kLegendRowPx = 20.0;
constexpr double kSamplePx = 30.0;
constexpr double kLegendGapPx = 20.0;

std::size_t characters_in(const std::string& text) {
  std::size_t count = 0;
  for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0U) == 0x80U ? 0 : 1;
  return count;
}

}  // namespace

std::string svg_head(const std::string& id,
                     const std::string& title,
                     const std::string& description,
                     double width_px,
                     double height_px) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 " +
         attribute_number(width_px) + " " + attribute_number(height_px) + "\" aria-labelledby=\"" +
         id + "-t " + id + "-d\">\n<title id=\"" + id + "-t\">" + escaped(title) +
         "</title>\n<desc id=\"" + id + "-d\">" + escaped(description) + "</desc>\n";
}

std::string svg_text(double x,
                     double y,
                     const std::string& anchor,
                     const std::string& css_class,
                     const std::string& text) {
  return "<text class=\"" + css_class + "\" x=\"" + attribute_number(x) + "\" y=\"" +
         attribute_number(y) + "\" text-anchor=\"" + anchor + "\">" + escaped(text) + "</text>\n";
}

std::string svg_line(double x1, double y1, double x2, double y2, const std::string& css_class) {
  return "<path class=\"" + css_class + "\" d=\"M" + attribute_number(x1) + " " +
         attribute_number(y1) + "L" + attribute_number(x2) + " " + attribute_number(y2) + "\"/>\n";
}

double text_width_px(const std::string& text) {
  return 6.6 * static_cast<double>(characters_in(text));
}

std::string label_text(const std::string& text, std::size_t most) {
  const std::string clean = clean_text(text);
  if (characters_in(clean) <= most) return clean;
  std::size_t bytes = 0;
  for (std::size_t count = 0; bytes < clean.size(); ++bytes) {
    const bool starts = (static_cast<unsigned char>(clean[bytes]) & 0xC0U) != 0x80U;
    if (starts && ++count >= most) break;
  }
  return clean.substr(0, bytes) + "\xE2\x80\xA6";
}

Legend legend_of(const std::vector<LegendEntry>& entries, double left_px, double right_px) {
  Legend legend;
  double x = left_px;
  double y = kLegendRowPx - 7.0;
  for (const LegendEntry& entry : entries) {
    const std::string label = label_text(entry.label);
    const double width = kSamplePx + 6.0 + text_width_px(label);
    if (x > left_px && x + width > right_px) {
      x = left_px;
      y += kLegendRowPx;
    }
    legend.markup += svg_line(x, y - 4.0, x + kSamplePx, y - 4.0, entry.css_class);
    legend.markup += svg_text(x + kSamplePx + 6.0, y, "start", "key", label);
    x += width + kLegendGapPx;
  }
  if (!entries.empty()) legend.height_px = y + 9.0;
  return legend;
}

}  // namespace overfly::server::plot
