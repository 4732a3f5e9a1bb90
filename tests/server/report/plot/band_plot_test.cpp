#include "server/report/plot/band_plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/server/report/markup_reader.hpp"

namespace overfly::server::plot {
namespace {

using report::testing::read_markup;

TEST(BandPlot, JoinsNeighboursOfOneKind) {
  const std::vector<Band> joined = joined_bands({{0, 1, BandKind::kInitialising},
                                                 {1, 2, BandKind::kTracking},
                                                 {2, 3, BandKind::kTracking},
                                                 {3.5, 4, BandKind::kTracking},
                                                 {4, 5, BandKind::kLost}},
                                                {0, 5});
  ASSERT_EQ(joined.size(), 4U);
  EXPECT_EQ(joined[1].to, 3.0);
  EXPECT_EQ(joined[2].from, 3.5);  // no answer in between
  EXPECT_EQ(joined[3].kind, BandKind::kLost);
}

/// However often the state changes, bands are few and every loss is in one of them.
TEST(BandPlot, ShowsTheWorstStateOfAColumn) {
  std::vector<Band> bands;
  std::vector<double> losses;
  for (int i = 0; i < 100'000; ++i) {
    const bool lost = i % 997 == 5;
    const double from = 0.01 * i;
    if (lost) losses.push_back(from + 0.005);
    const BandKind kind = lost         ? BandKind::kLost
                          : i % 2 == 0 ? BandKind::kTracking
                                       : BandKind::kInitialising;
    bands.push_back({from, 0.01 * (i + 1), kind});
  }
  const std::vector<Band> joined = joined_bands(bands, {0.0, 1000.0});
  EXPECT_LE(joined.size(), kMaxBands);
  for (const double at : losses) {
    EXPECT_TRUE(std::any_of(joined.begin(), joined.end(), [&](const Band& band) {
      return band.kind == BandKind::kLost && band.from <= at && at <= band.to;
    })) << at;
  }
  // No more than one column around each loss.
  double lost_s = 0.0;
  for (const Band& band : joined) {
    if (band.kind == BandKind::kLost) lost_s += band.to - band.from;
  }
  EXPECT_LE(lost_s, 2.0 * static_cast<double>(losses.size()));
}

TEST(BandPlot, DiffersInHeightAsWellAsInColour) {
  BandPlot plot;
  plot.id = "b";
  plot.x_range = {0.0, 10.0};
  plot.rows = {{"<b>\"",
                {{0, 2, BandKind::kInitialising},
                 {2, 9, BandKind::kTracking},
                 {9, 9.0001, BandKind::kLost}}}};
  const auto markup = read_markup(svg_of(plot));
  ASSERT_EQ(markup.fault, "");
  const auto bars = markup.named("rect");
  ASSERT_EQ(bars.size(), 6U);  // three of the legend
  EXPECT_GT(std::stod(bars[4].attribute("height")), std::stod(bars[3].attribute("height")));
  EXPECT_GT(std::stod(bars[3].attribute("height")), std::stod(bars[5].attribute("height")));
  EXPECT_GT(std::stod(bars[5].attribute("width")), 0.5);  // a single frame can be seen
}

}  // namespace
}  // namespace overfly::server::plot
