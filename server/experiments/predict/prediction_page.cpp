#include "server/experiments/predict/prediction_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "core/text/percent.hpp"
#include "server/experiments/predict/prediction_words.hpp"
#include "server/files/jpeg.hpp"
#include "server/report/html_parts.hpp"
#include "server/report/plot/line_plot.hpp"
#include "server/report/plot/markup.hpp"

namespace overfly::server::predict {
namespace {

namespace html = server::report;
using plot::LinePlot;
using plot::Point;

constexpr double kMapWidthPx = 900.0;
constexpr double kSmallWidthPx = 446.0;
constexpr double kSmallHeightPx = 120.0;
constexpr double kColourShare = 0.55;  ///< of a risk's colour over the ground
constexpr int kJpegQuality = 85;

std::vector<Point> over_time(const Prediction& prediction,
                             const std::function<double(const PredictedInstant&)>& value) {
  std::vector<Point> points;
  points.reserve(prediction.instants.size());
  for (const PredictedInstant& instant : prediction.instants) {
    points.push_back({instant.t_s, value(instant)});
  }
  return points;
}

std::string risk_figure(const Prediction& prediction) {
  LinePlot risk;
  risk.id = "risk";
  risk.title = "Risk over the flight";
  risk.description = sentences_of(prediction).front();
  risk.x_label = "time of the flight [s]";
  risk.y_label = "risk [%]";
  risk.y_range = plot::Range{0.0, 100.0};
  risk.series = {{"of a loss within 10 s of such conditions",
                  2,
                  over_time(prediction, [](const auto& at) { return 100.0 * at.risk; })}};
  if (prediction.risk) {
    risk.series.push_back(
        {"of a loss since the start", 1, over_time(prediction, [](const auto& at) {
           return 100.0 * at.risk_so_far;
         })});
  }
  risk.levels = {{100.0 * kRisky, "risky"}};
  return html::figure(
      "Time line of risk.", "Probabilities that the estimator is lost.", plot::svg_of(risk));
}

struct FeaturePlot {
  const char* id;
  const char* title;
  const char* unit;
  double (*value)(const Features&);
};

const std::vector<FeaturePlot>& feature_plots() {
  static const std::vector<FeaturePlot> plots = {
      {"texels", "Texels per pixel", "texels", [](const auto& f) { return f.texels_per_pixel; }},
      {"corners",
       "Corners after blur, per 1000 px",
       "corners",
       [](const auto& f) { return f.corners_per_kpx; }},
      {"bare", "Image without corners", "%", [](const auto& f) { return 100.0 * f.bare_share; }},
      {"similarity",
       "Self-similarity within 20 px",
       "correlation",
       [](const auto& f) { return f.self_similarity; }},
      {"rotation",
       "Motion between frames by rotation",
       "px",
       [](const auto& f) { return f.rotation_px; }},
      {"translation",
       "Motion between frames by translation",
       "px",
       [](const auto& f) { return f.translation_px; }},
      {"overlap",
       "Overlap with the image 1 s later",
       "%",
       [](const auto& f) { return 100.0 * f.overlap; }},
      {"blur", "Motion blur", "px", [](const auto& f) { return f.blur_px; }},
      {"relief", "Relief over height", "%", [](const auto& f) { return 100.0 * f.relief; }},
      {"noise", "Noise", "grey levels", [](const auto& f) { return f.noise_grey; }},
      {"void", "Image without imagery", "%", [](const auto& f) { return 100.0 * f.void_share; }}};
  return plots;
}

std::string feature_figures(const Prediction& prediction) {
  std::string figures = "<div class=\"pair\">\n";
  for (const FeaturePlot& each : feature_plots()) {
    LinePlot plot;
    plot.id = std::string("feature-") + each.id;
    plot.title = each.title;
    plot.description = std::string(each.title) + " over the time of the flight.";
    plot.x_label = "time of the flight [s]";
    plot.y_label = each.unit;
    plot.width_px = kSmallWidthPx;
    plot.area_height_px = kSmallHeightPx;
    plot.from_zero = true;
    plot.legend = false;
    plot.series = {{each.title, 1, over_time(prediction, [&](const auto& at) {
                      return each.value(at.features);
                    })}};
    figures += html::figure(std::string(each.title) + ".", "", plot::svg_of(plot));
  }
  return figures + "</div>\n";
}

std::string legend() {
  std::string text = "<p>Risk of a loss within 10 s:";
  for (const RiskColour& colour : kRiskColours) {
    char css[80];
    std::snprintf(css,
                  sizeof css,
                  "background:rgb(%d,%d,%d);color:#000;padding:.1rem .5rem",
                  colour.rgb[0],
                  colour.rgb[1],
                  colour.rgb[2]);
    text += " <span style=\"" + std::string(css) + "\">" + colour.words + "</span>";
  }
  return text + "; no colour: no imagery.</p>\n";
}

Result<std::string> map_figure(const Prediction& prediction, const Image& ground) {
  const RiskMap& map = *prediction.map;
  const auto jpeg = encode_jpeg(coloured_map(map, ground), kJpegQuality);
  if (!jpeg) return jpeg.error();
  LinePlot picture;
  picture.id = "map";
  picture.title = "Map of risk";
  picture.description = sentences_of(prediction).back();
  picture.x_label = "east [m]";
  picture.y_label = "north [m]";
  picture.map = true;
  picture.width_px = kMapWidthPx;
  const double width_m = map.cell_m * static_cast<double>(map.columns);
  const double height_m = map.cell_m * static_cast<double>(map.rows);
  picture.area_height_px = plot::area_width_px(kMapWidthPx) * height_m / width_m;
  picture.x_range = plot::Range{map.west_m, map.west_m + width_m};
  picture.y_range = plot::Range{map.south_m, map.south_m + height_m};
  picture.background_uri = "data:image/jpeg;base64," + plot::base64(*jpeg);
  std::vector<Point> track;
  for (const PredictedInstant& instant : prediction.instants) {
    const bool inside =
        instant.east_m >= picture.x_range->low && instant.east_m <= picture.x_range->high &&
        instant.north_m >= picture.y_range->low && instant.north_m <= picture.y_range->high;
    track.push_back({instant.east_m, inside ? instant.north_m : plot::kGap});
  }
  if (!track.empty() && !track.front().is_gap()) picture.markers = {{track.front(), "start"}};
  picture.series = {{"flight", 0, track}};
  char caption[200];
  std::snprintf(
      caption,
      sizeof caption,
      "Straight and level at %.0f m over the ground, %.1f m/s, heading %.0f deg; cells of "
      "%.0f m. Axes of the world frame.",
      map.height_agl_m,
      map.speed_m_s,
      map.heading_deg,
      map.cell_m);
  return html::figure("Map of risk.", caption, plot::svg_of(picture)) + legend();
}

std::string formatted(double value, const char* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string stretches_table(const Prediction& prediction) {
  const std::vector<RiskyStretch> stretches = risky_stretches(prediction);
  if (stretches.empty()) return "";
  constexpr std::size_t kMostRows = 100;
  html::Table table;
  table.caption = "Parts of the flight with a risk of at least 50 % within 10 s";
  if (stretches.size() > kMostRows) table.caption += "; the first 100";
  table.head = {{"From [s]"}, {"To [s]", true}, {"Highest risk", true}, {"Reasons"}};
  for (std::size_t i = 0; i < std::min(stretches.size(), kMostRows); ++i) {
    const PredictedInstant& worst = prediction.instants[stretches[i].worst];
    std::string reasons;
    for (const std::string& reason : reasons_of(worst)) {
      reasons += (reasons.empty() ? "" : ", ") + reason;
    }
    table.rows.push_back({{formatted(prediction.instants[stretches[i].first].t_s, "%.1f")},
                          {formatted(prediction.instants[stretches[i].last].t_s, "%.1f"), true},
                          {percent_text(worst.risk), true},
                          {reasons}});
  }
  return html::heading(2, "Risky parts") + html::table(table);
}

}  // namespace

const RiskColour& colour_of(double risk) {
  return *std::find_if(kRiskColours.begin(), kRiskColours.end() - 1, [&](const auto& colour) {
    return risk < colour.below;
  });
}

Image coloured_map(const RiskMap& map, const Image& ground) {
  Image picture = ground;
  for (int y = 0; y < picture.height_px; ++y) {
    for (int x = 0; x < picture.width_px; ++x) {
      const auto cell_of = [](int at, int size, std::size_t cells) {
        const double share = (at + 0.5) / size;
        return std::min(cells - 1, static_cast<std::size_t>(share * static_cast<double>(cells)));
      };
      const std::size_t column = cell_of(x, picture.width_px, map.columns);
      const std::size_t row = map.rows - 1 - cell_of(y, picture.height_px, map.rows);
      const auto& risk = map.risk[map.index(column, row)];
      if (!risk) continue;
      const RiskColour& colour = colour_of(*risk);
      for (int channel = 0; channel < 3; ++channel) {
        std::uint8_t& value = picture.at(x, y, channel);
        value = static_cast<std::uint8_t>(
            std::lround((1.0 - kColourShare) * value +
                        kColourShare * colour.rgb[static_cast<std::size_t>(channel)]));
      }
    }
  }
  return picture;
}

Result<std::string> page_of(const Prediction& prediction, const Image& ground) {
  const std::string name = prediction.title.empty() ? prediction.scenario : prediction.title;
  std::string page = html::page_start("Risk: " + name + " - Overfly") + "<h1>" +
                     plot::escaped("Risk: " + name) + "</h1>\n" +
                     html::paragraph("Prediction by Overfly " + html::program_text() + " for " +
                                         prediction.flight + ", camera " + prediction.camera +
                                         ". Nothing was flown.",
                                     "lead");
  const std::vector<std::string> sentences = sentences_of(prediction);
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    page += html::paragraph(sentences[i], i == 0 ? "verdict" : "");
  }
  // The dashboard, which shows the sentences itself, opens the page here.
  page +=
      "<div id=\"time-line\"></div>\n" + html::heading(2, "Time line") + risk_figure(prediction);
  if (prediction.map && !ground.empty()) {
    const auto map = map_figure(prediction, ground);
    if (!map) return map.error();
    page += html::heading(2, "Map") + *map;
  }
  page += stretches_table(prediction);
  page += html::heading(2, "Features") + feature_figures(prediction);
  if (!prediction.warnings.empty()) {
    page += html::heading(2, "Warnings");
    for (const std::string& warning : prediction.warnings) page += html::paragraph(warning);
  }
  return page + "</body>\n</html>\n";
}

}  // namespace overfly::server::predict
