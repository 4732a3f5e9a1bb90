#include "server/experiments/explain/cause_picture.hpp"

#include <algorithm>
#include <cmath>

#include "server/experiments/explain/explanation_words.hpp"
#include "server/report/plot/markup.hpp"
#include "server/report/plot/svg_parts.hpp"

namespace overfly::server::experiments {
namespace {

using plot::attribute_number;
using plot::svg_line;
using plot::svg_text;

constexpr double kWidthPx = 900.0;
constexpr double kNamesPx = 250.0;
constexpr double kNecessaryPx = 270.0;
constexpr double kSufficientPx = 390.0;
constexpr double kMarginPx = 520.0;
constexpr double kMarginWidthPx = 340.0;
constexpr double kHeadPx = 28.0;
constexpr double kRowPx = 30.0;
constexpr double kBarPx = 16.0;

/// A full disc for yes, a ring for no, nothing but the words for what was not tried.
std::string mark(double x, double y, const std::optional<bool>& value) {
  if (!value) return svg_text(x, y + 4.0, "start", "label", "not tried");
  const std::string disc = "<circle class=\"" + std::string(*value ? "mark-yes" : "mark-no") +
                           "\" cx=\"" + attribute_number(x + 7.0) + "\" cy=\"" +
                           attribute_number(y) + "\" r=\"6\"/>\n";
  return disc + svg_text(x + 20.0, y + 4.0, "start", "key", *value ? "yes" : "no");
}

double margin_px(double share) { return kMarginPx + kMarginWidthPx * std::clamp(share, 0.0, 1.0); }

std::string part_of_bar(const char* css_class, double from, double to, double y) {
  return std::string("<rect class=\"") + css_class + "\" x=\"" + attribute_number(margin_px(from)) +
         "\" y=\"" + attribute_number(y - 0.5 * kBarPx) + "\" width=\"" +
         attribute_number(std::max(margin_px(to) - margin_px(from), 2.0)) + "\" height=\"" +
         attribute_number(kBarPx) + "\"/>\n";
}

std::string margin_bar(const CauseMargin& margin, double y) {
  return part_of_bar("band-tracking", 0.0, margin.survives_share, y) +
         part_of_bar("band-lost", margin.fails_share, 1.0, y);
}

std::string margin_axis(double top, double bottom) {
  std::string markup;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double x = margin_px(share);
    markup += svg_line(x, top, x, bottom, "grid");
    const std::string text = std::to_string(std::lround(100.0 * share));
    markup += svg_text(x, bottom + 18.0, "middle", "tick", text);
  }
  return markup + svg_text(0.5 * (margin_px(0.0) + margin_px(1.0)),
                           bottom + 35.0,
                           "middle",
                           "label",
                           "share of the cause that is left [%]");
}

std::string yes_or_no(const std::optional<bool>& value) {
  if (!value) return "not tried";
  return *value ? "yes" : "no";
}

}  // namespace

std::string cause_picture(const std::vector<CauseFinding>& findings) {
  const bool has_margin = std::any_of(findings.begin(), findings.end(), [](const auto& finding) {
    return finding.margin.has_value();
  });
  const double bottom = kHeadPx + kRowPx * static_cast<double>(findings.size());
  std::string body = svg_text(kNecessaryPx, 18.0, "start", "label", "necessary") +
                     svg_text(kSufficientPx, 18.0, "start", "label", "sufficient");
  if (has_margin) {
    body += svg_text(kMarginPx, 18.0, "start", "label", "survives (left) and fails (right)") +
            margin_axis(kHeadPx, bottom);
  }
  std::string description;
  double y = kHeadPx + 0.5 * kRowPx;
  for (const CauseFinding& finding : findings) {
    const std::string name = words_for(finding.cause);
    body += svg_line(0.0, y + 0.5 * kRowPx, kWidthPx, y + 0.5 * kRowPx, "grid") +
            svg_text(kNamesPx, y + 4.0, "end", "key", plot::label_text(name, 36)) +
            mark(kNecessaryPx, y, finding.necessary) + mark(kSufficientPx, y, finding.sufficient);
    if (finding.margin) body += margin_bar(*finding.margin, y);
    description += name + ": necessary " + yes_or_no(finding.necessary) + ", sufficient " +
                   yes_or_no(finding.sufficient) +
                   (finding.margin ? ", " + margin_words(*finding.margin) : "") + ". ";
    y += kRowPx;
  }
  return plot::svg_head("causes",
                        "What was found of each cause",
                        description,
                        kWidthPx,
                        bottom + (has_margin ? 42.0 : 6.0)) +
         body + "</svg>\n";
}

}  // namespace overfly::server::experiments
