// Plots as a reader of SVG sees them.
#include "server/report/plot/line_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/server/report/markup_reader.hpp"

namespace overfly::server::plot {
namespace {

using report::testing::Element;
using report::testing::Markup;
using report::testing::read_markup;
using ::testing::HasSubstr;
using ::testing::Not;

LinePlot plot_of(std::vector<Point> points) {
  LinePlot plot;
  plot.id = "p";
  plot.title = "Title";
  plot.description = "What it shows";
  plot.x_label = "time [s]";
  plot.y_label = "error [m]";
  plot.series = {{"a", 1, std::move(points)}};
  return plot;
}

std::string path_of_class(const std::string& svg, const std::string& css_class) {
  for (const Element& path : read_markup(svg).named("path")) {
    if (path.attribute("class") == css_class && path.attribute("d").size() > 12) {
      return path.attribute("d");
    }
  }
  return "";
}

/// The line itself is the last of its class; the first is its sample in the legend.
std::string drawn_line(const std::string& svg, const std::string& css_class = "line s1") {
  std::string last;
  for (const Element& path : read_markup(svg).named("path")) {
    if (path.attribute("class") == css_class) last = path.attribute("d");
  }
  return last;
}

TEST(LinePlot, IsWellFormedAndReadableWithoutSeeing) {
  const std::string svg = svg_of(plot_of({{0, 1}, {1, 2}, {2, 1.5}}));
  const Markup markup = read_markup(svg);
  ASSERT_EQ(markup.fault, "");
  EXPECT_EQ(markup.elements.front().attribute("role"), "img");
  EXPECT_EQ(markup.elements.front().attribute("aria-labelledby"), "p-t p-d");
  ASSERT_EQ(markup.named("title").size(), 1U);
  EXPECT_EQ(markup.named("title")[0].text, "Title");
  EXPECT_EQ(markup.named("desc")[0].text, "What it shows");
  EXPECT_EQ(markup.named("desc")[0].attribute("id"), "p-d");
  std::vector<std::string> texts;
  for (const Element& text : markup.named("text")) texts.push_back(text.text);
  EXPECT_THAT(texts, ::testing::IsSupersetOf({"time [s]", "error [m]", "a", "0.0", "2.0"}));
}

/// The mapping of values to pixels: the left end, the right end and the middle of the area.
TEST(LinePlot, DrawsValuesWhereTheAxesSay) {
  LinePlot plot = plot_of({{0, 0}, {5, 50}, {10, 100}});
  plot.legend = false;
  plot.y_range = Range{0.0, 100.0};
  plot.area_height_px = 200.0;
  const std::string svg = svg_of(plot);
  const Element frame = read_markup(svg).named("rect").back();
  const double left = std::stod(frame.attribute("x"));
  const double top = std::stod(frame.attribute("y"));
  const double width = std::stod(frame.attribute("width"));
  EXPECT_NEAR(width, area_width_px(plot.width_px), 1e-9);
  double x[3];
  double y[3];
  ASSERT_EQ(std::sscanf(drawn_line(svg).c_str(),
                        "M%lf %lfL%lf %lfL%lf %lf",
                        &x[0],
                        &y[0],
                        &x[1],
                        &y[1],
                        &x[2],
                        &y[2]),
            6);
  EXPECT_NEAR(x[0], left, 0.06);
  EXPECT_NEAR(x[1], left + 0.5 * width, 0.06);
  EXPECT_NEAR(x[2], left + width, 0.06);
  EXPECT_NEAR(y[0], top + 200.0, 0.06);
  EXPECT_NEAR(y[1], top + 100.0, 0.06);
  EXPECT_NEAR(y[2], top, 0.06);
}

TEST(LinePlot, GapsAreGapsAndLonePointsAreDots) {
  const std::string line =
      drawn_line(svg_of(plot_of({{0, 1}, {1, 2}, {2, kGap}, {3, 5}, {4, kGap}, {5, 3}, {6, 4}})));
  EXPECT_EQ(std::count(line.begin(), line.end(), 'M'), 3);
  EXPECT_EQ(std::count(line.begin(), line.end(), 'L'), 2);
  EXPECT_THAT(line, HasSubstr("h0M"));
}

TEST(LinePlot, ALogarithmicAxisShowsRatios) {
  LinePlot plot = plot_of({{0, 0.1}, {1, 1.0}, {2, 10.0}, {3, 0.0}, {4, -1.0}});
  plot.logarithmic = true;
  const std::string line = drawn_line(svg_of(plot));
  double x[3];
  double y[3];
  ASSERT_EQ(std::sscanf(
                line.c_str(), "M%lf %lfL%lf %lfL%lf %lf", &x[0], &y[0], &x[1], &y[1], &x[2], &y[2]),
            6);
  EXPECT_NEAR(y[0] - y[1], y[1] - y[2], 0.11);
  EXPECT_EQ(std::count(line.begin(), line.end(), 'L'), 2);  // 0 and -1 are not shown
}

TEST(LinePlot, HasNoNumberThatIsNone) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const std::vector<Point>& points : {std::vector<Point>{},
                                           std::vector<Point>{{0, kGap}},
                                           std::vector<Point>{{3, 7}},
                                           std::vector<Point>{{0, inf}, {1, -inf}, {2, 1}},
                                           std::vector<Point>{{0, 1e300}, {1, -1e300}},
                                           std::vector<Point>{{0, 1.7e308}, {1, -1.7e308}},
                                           std::vector<Point>{{0, 1.7e308}, {1, 1.7e308}},
                                           std::vector<Point>{{0, 1e-310}, {1, 2e-320}},
                                           std::vector<Point>{{0, 0}, {1, 0}}}) {
    for (const bool logarithmic : {false, true}) {
      LinePlot plot = plot_of(points);
      plot.logarithmic = logarithmic;
      plot.map = true;
      const std::string svg = svg_of(plot);
      EXPECT_EQ(read_markup(svg).fault, "");
      EXPECT_THAT(svg, Not(HasSubstr("nan")));
      EXPECT_THAT(svg, Not(HasSubstr("inf")));
    }
  }
}

TEST(LinePlot, TextsCannotBecomeMarkup) {
  const std::string hostile = "</text><script>alert(1)</script>\"' ]]>\x01\xFF&";
  LinePlot plot = plot_of({{0, 1}, {1, 2}});
  plot.title = hostile;
  plot.description = hostile;
  plot.x_label = hostile;
  plot.y_label = hostile;
  plot.series[0].label = hostile;
  plot.levels = {{1.5, hostile}};
  plot.markers = {{{0, 1}, hostile}};
  const std::string svg = svg_of(plot);
  const Markup markup = read_markup(svg);
  EXPECT_EQ(markup.fault, "");
  EXPECT_TRUE(markup.named("script").empty());
  EXPECT_THAT(markup.named("title")[0].text, HasSubstr("<script>alert(1)</script>\"' ]]>"));
}

TEST(LinePlot, AMapHasAScaleBarOfARoundLength) {
  LinePlot plot = plot_of({{0, 0}, {1000, 500}});
  plot.map = true;
  plot.x_range = Range{0.0, 4000.0};
  plot.y_range = Range{0.0, 2000.0};
  plot.background_uri = "data:image/jpeg;base64,AAAA";
  const std::string svg = svg_of(plot);
  EXPECT_THAT(svg, HasSubstr(">1 km</text>"));
  EXPECT_THAT(svg, HasSubstr(">N</text>"));
  const std::string bar = path_of_class(svg, "bar");
  double x = 0.0;
  double y = 0.0;
  double length = 0.0;
  ASSERT_EQ(std::sscanf(bar.c_str(), "M%lf %lfv7h%lfv-7", &x, &y, &length), 3);
  EXPECT_NEAR(length, area_width_px(plot.width_px) / 4.0, 0.06);
  ASSERT_EQ(read_markup(svg).named("image").size(), 1U);
  EXPECT_EQ(read_markup(svg).named("image")[0].attribute("href"), plot.background_uri);
}

TEST(LinePlot, LongLinesMakeSmallFiles) {
  std::vector<Point> points;
  for (int i = 0; i < 200'000; ++i) points.push_back({0.03 * i, std::sin(0.7 * i)});
  EXPECT_LT(svg_of(plot_of(points)).size(), 60'000U);
}

}  // namespace
}  // namespace overfly::server::plot
