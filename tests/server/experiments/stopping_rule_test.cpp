// The rule that ends repeats, computed exactly: the figures of docs/SWEEPS.md, "Success rate".
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "evaluation/statistics/wilson.hpp"
#include "server/experiments/sweep_plan.hpp"

namespace overfly::server::experiments {
namespace {

constexpr int kMost = 20;

struct Repeats {
  double flights = 0.0;   ///< mean number
  double coverage = 0.0;  ///< probability that the last interval contains the rate
};

/// Of a cell with this success rate: all sequences of outcomes with their probabilities.
Repeats repeats_at(double rate, double half_width) {
  const RepeatRule rule{kMost, half_width, false, 0.0};
  Repeats repeats;
  std::vector<double> going_on{1.0};  // by the number of successes
  for (int n = 1; n <= kMost; ++n) {
    std::vector<double> now(going_on.size() + 1, 0.0);
    for (std::size_t k = 0; k < going_on.size(); ++k) {
      now[k] += going_on[k] * (1.0 - rate);
      now[k + 1] += going_on[k] * rate;
    }
    for (int k = 0; k <= n; ++k) {
      double& probability = now[static_cast<std::size_t>(k)];
      if (!has_enough(rule, k, n)) continue;
      const auto interval = evaluation::wilson_interval(k, n);
      repeats.flights += probability * n;
      if (interval.low - 1e-12 <= rate && rate <= interval.high + 1e-12) {
        repeats.coverage += probability;
      }
      probability = 0.0;
    }
    going_on = std::move(now);
  }
  return repeats;
}

struct Figures {
  double mean_flights = 0.0, at_edge = 0.0, mean_coverage = 0.0, least_coverage = 1.0;
};

Figures figures_of(double half_width) {
  constexpr int kRates = 20;
  Figures figures;
  for (int i = 0; i <= kRates; ++i) {
    const Repeats repeats = repeats_at(static_cast<double>(i) / kRates, half_width);
    figures.mean_flights += repeats.flights / (kRates + 1);
    figures.mean_coverage += repeats.coverage / (kRates + 1);
    figures.least_coverage = std::min(figures.least_coverage, repeats.coverage);
  }
  figures.at_edge = repeats_at(0.0, half_width).flights;
  EXPECT_DOUBLE_EQ(repeats_at(1.0, half_width).flights, figures.at_edge);
  return figures;
}

TEST(StoppingRule, CoversTheRateAsDocumented) {
  struct Row {
    double half_width, mean_flights, at_edge, mean_coverage, least_coverage;
  };
  for (const Row& row : {Row{0.10, 19.3, 16, 0.960, 0.925},
                         Row{0.12, 18.6, 13, 0.960, 0.917},
                         Row{0.15, 16.9, 9, 0.959, 0.924}}) {
    const Figures figures = figures_of(row.half_width);
    EXPECT_NEAR(figures.mean_flights, row.mean_flights, 0.05) << row.half_width;
    EXPECT_DOUBLE_EQ(figures.at_edge, row.at_edge) << row.half_width;
    EXPECT_NEAR(figures.mean_coverage, row.mean_coverage, 0.0005) << row.half_width;
    EXPECT_NEAR(figures.least_coverage, row.least_coverage, 0.0005) << row.half_width;
    EXPECT_GE(figures.mean_coverage, 0.94);
  }
}

TEST(StoppingRule, FewerThanSixteenFlightsNeverReachATenth) {
  for (int n = 1; n < 16; ++n) {
    for (int k = 0; k <= n; ++k) {
      EXPECT_GT(evaluation::wilson_interval(k, n).half_width(), 0.1) << k << " of " << n;
    }
  }
  EXPECT_LE(evaluation::wilson_interval(16, 16).half_width(), 0.1);
}

}  // namespace
}  // namespace overfly::server::experiments
