#include "server/report/plot/band_plot.hpp"

#include <algorithm>
#include <cmath>

#include "server/report/plot/markup.hpp"
#include "server/report/plot/svg_parts.hpp"

namespace overfly::server::plot {
namespace {

/// Room for the names of the rows, and at most.
constexpr double kNamesPx = 200.0;
constexpr double kMostNamesPx = 330.0;
constexpr double kEndPx = 16.0;
constexpr double kRowPx = 30.0;
constexpr double kBarPx = 20.0;
constexpr std::size_t kNameCharacters = 46;

struct Look {
  const char* css_class;
  const char* label;
  double height;  ///< share of the row's bar
};

Look look_of(BandKind kind) {
  switch (kind) {
    case BandKind::kTracking:
      return {"band-tracking", "tracking (full height)", 1.0};
    case BandKind::kInitialising:
      return {"band-initialising", "initialising (half height)", 0.5};
    case BandKind::kLost:
      return {"band-lost", "lost (quarter height)", 0.25};
    case BandKind::kNone:
      break;
  }
  return {"band-none", "", 0.0};
}

std::vector<Band> joined_neighbours(const std::vector<Band>& bands) {
  std::vector<Band> joined;
  for (const Band& band : bands) {
    const bool same =
        !joined.empty() && joined.back().kind == band.kind && joined.back().to >= band.from;
    if (same) {
      joined.back().to = std::max(joined.back().to, band.to);
    } else {
      joined.push_back(band);
    }
  }
  return joined;
}

std::string bar(double x, double width, double bottom, const Look& look) {
  return std::string("<rect class=\"") + look.css_class + "\" x=\"" + attribute_number(x, 2) +
         "\" y=\"" + attribute_number(bottom - look.height * kBarPx) + "\" width=\"" +
         attribute_number(width, 2) + "\" height=\"" + attribute_number(look.height * kBarPx) +
         "\"/>\n";
}

double names_px(const std::vector<BandRow>& rows) {
  double widest = kNamesPx;
  for (const BandRow& row : rows) widest = std::max(widest, text_width_px(row.label) + 14.0);
  return std::min(widest, kMostNamesPx);
}

std::string bands_legend(double left_px, double* height) {
  std::string markup;
  double x = left_px;
  for (const BandKind kind : {BandKind::kTracking, BandKind::kInitialising, BandKind::kLost}) {
    const Look look = look_of(kind);
    markup += bar(x, 22.0, 22.0, look);
    markup += svg_text(x + 28.0, 17.0, "start", "key", look.label);
    x += 28.0 + text_width_px(look.label) + 22.0;
  }
  *height = 32.0;
  return markup;
}

}  // namespace

std::vector<Band> joined_bands(const std::vector<Band>& bands,
                               const Range& range,
                               std::size_t most) {
  std::vector<Band> joined = joined_neighbours(bands);
  if (joined.size() <= most) return joined;
  const double width = range.span() / static_cast<double>(most);
  std::vector<Band> columns(most);
  for (std::size_t i = 0; i < most; ++i) {
    columns[i].from = range.low + width * static_cast<double>(i);
    columns[i].to = range.low + width * static_cast<double>(i + 1);
  }
  const auto column_of = [&](double at) {
    const double column = std::floor((at - range.low) / width);
    return static_cast<std::size_t>(std::clamp(column, 0.0, static_cast<double>(most - 1)));
  };
  for (const Band& band : joined) {
    for (std::size_t i = column_of(band.from); i <= column_of(band.to); ++i) {
      if (columns[i].from >= band.to && band.to > band.from) break;
      columns[i].kind = std::max(columns[i].kind, band.kind);
    }
  }
  return joined_neighbours(columns);
}

std::string svg_of(const BandPlot& plot) {
  const Range range = usable(plot.x_range);
  const double left = names_px(plot.rows);
  const double width = plot.width_px - left - kEndPx;
  const auto px = [&](double x) {
    return left + width * std::clamp((x - range.low) / range.span(), 0.0, 1.0);
  };
  double top = 0.0;
  std::string body = bands_legend(kNamesPx, &top);
  const double bottom = top + kRowPx * static_cast<double>(plot.rows.size()) + 4.0;
  const Ticks ticks = nice_ticks(range, 9);
  for (const double value : ticks.values) {
    body += svg_line(px(value), top, px(value), bottom, "grid");
    body += svg_text(px(value), bottom + 18.0, "middle", "tick", tick_text(value, ticks));
  }
  double row_bottom = top;
  for (const BandRow& row : plot.rows) {
    row_bottom += kRowPx;
    body += svg_text(
        left - 10.0, row_bottom - 9.0, "end", "key", label_text(row.label, kNameCharacters));
    for (const Band& band : joined_bands(row.bands, range)) {
      if (band.kind == BandKind::kNone) continue;
      // A state of a single frame stays visible.
      const double size = std::max(px(band.to) - px(band.from), 0.8);
      body += bar(px(band.from), size, row_bottom - 4.0, look_of(band.kind));
    }
    body += svg_line(left, row_bottom - 4.0, left + width, row_bottom - 4.0, "axis");
  }
  body += svg_text(left + 0.5 * width, bottom + 35.0, "middle", "label", plot.x_label);
  return svg_head(plot.id, plot.title, plot.description, plot.width_px, bottom + 42.0) + body +
         "</svg>\n";
}

}  // namespace overfly::server::plot
