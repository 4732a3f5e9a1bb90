#include "server/report/plot/shared_range.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/report/plot/line_plot.hpp"

namespace overfly::server::plot {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Series line(const std::string& label, int style, double low, double high) {
  return {label, style, {{0, low}, {1, high}, {2, kGap}}};
}

TEST(SharedRange, EnclosesTruthAndEstimatesAlsoOneThatIsFarOff) {
  const SharedRange shared =
      shared_y_range({line("truth", 0, -10, 90), line("a", 1, -900, 0), line("b", 2, 0, 95)}, 2.0);
  EXPECT_EQ(shared.range.low, -900.0);
  EXPECT_EQ(shared.range.high, 95.0);
  EXPECT_THAT(shared.beyond, IsEmpty());
}

TEST(SharedRange, LeavesOutDivergedEstimatesWhateverTheirOrder) {
  const SharedRange shared = shared_y_range({line("worst", 1, 0, 3e12),
                                             line("truth", 0, -10, 90),
                                             line("bad", 2, -5e5, 0),
                                             line("good", 3, 0, 100)},
                                            2.0);
  EXPECT_EQ(shared.range.low, -10.0);
  EXPECT_EQ(shared.range.high, 100.0);
  EXPECT_THAT(shared.beyond, ElementsAre("bad", "worst"));
}

TEST(SharedRange, ShowsADivergedEstimateWholeIfNothingElseIsShown) {
  const SharedRange shared = shared_y_range({line("a", 1, 0, 3e12)}, 0.1);
  EXPECT_EQ(shared.range.high, 3e12);
  EXPECT_THAT(shared.beyond, IsEmpty());
  EXPECT_GT(shared_y_range({}, 0.1).range.low, shared_y_range({}, 0.1).range.high);
}

TEST(SharedRange, KeepsLargeErrorsNextToSmallOnes) {
  const Series good = line("good", 1, 0, 0.05);
  EXPECT_THAT(shared_y_range({good, line("held", 2, 0, 698)}, 0.1).beyond, IsEmpty());
  EXPECT_THAT(shared_y_range({line("dso", 3, 0, 1e9), good, line("held", 2, 0, 698)}, 0.1).beyond,
              ElementsAre("dso"));
}

TEST(SharedRange, DecidesTheAxisOfAPlot) {
  LinePlot plot;
  plot.id = "p";
  plot.series = {line("dso", 1, 0, 2e12), line("feature", 2, 0, 0.5)};
  EXPECT_THAT(svg_of(plot), HasSubstr("2e+12"));
  plot.unbounded_from = 0.1;
  EXPECT_THAT(svg_of(plot), Not(HasSubstr("2e+12")));
  EXPECT_THAT(svg_of(plot), HasSubstr(">0.4<"));
}

}  // namespace
}  // namespace overfly::server::plot
