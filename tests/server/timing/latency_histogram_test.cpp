#include "server/timing/latency_histogram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "server/timing/stage_timer.hpp"

namespace overfly::server {
namespace {

/// Within 1 % of the exact percentiles, whatever the durations' spread.
TEST(LatencyHistogram, AgreesWithSortedDurations) {
  std::mt19937 generator(1);
  for (const double spread : {0.01, 0.5, 2.0}) {
    std::lognormal_distribution<double> durations(std::log(20.0), spread);
    LatencyHistogram histogram;
    DurationList list;
    for (int i = 0; i < 10'000; ++i) {
      list.ms.push_back(durations(generator));
      histogram.add(list.ms.back());
      if (i != 0 && i != 1 && i != 99 && i != 9999) continue;
      const LatencySummary exact = *list.latencies();
      const LatencySummary summary = *histogram.summary();
      EXPECT_NEAR(summary.median_ms, exact.median_ms, 0.0101 * exact.median_ms) << i;
      EXPECT_NEAR(summary.p95_ms, exact.p95_ms, 0.0101 * exact.p95_ms) << i;
      EXPECT_NEAR(summary.p99_ms, exact.p99_ms, 0.0101 * exact.p99_ms) << i;
      EXPECT_EQ(summary.max_ms, exact.max_ms);
    }
  }
}

TEST(LatencyHistogram, TakesAnyNumber) {
  LatencyHistogram histogram;
  EXPECT_FALSE(histogram.summary());
  for (const double ms : {0.0, -1.0, 1e-9, std::nan(""), 1e12}) histogram.add(ms);
  EXPECT_LT(histogram.summary()->median_ms, 1e-2);
  EXPECT_EQ(histogram.summary()->max_ms, 1e12);
  EXPECT_TRUE(std::isfinite(histogram.summary()->p99_ms));
}

}  // namespace
}  // namespace overfly::server
