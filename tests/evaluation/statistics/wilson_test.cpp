#include "evaluation/statistics/wilson.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace overfly::evaluation {
namespace {

/// R: prop.test(x, 10, correct = FALSE)$conf.int.
TEST(Wilson, AgreesWithR) {
  const ShareInterval eight = wilson_interval(8, 10);
  EXPECT_NEAR(eight.low, 0.4901625, 1e-7);
  EXPECT_NEAR(eight.high, 0.9433178, 1e-7);
  const ShareInterval none = wilson_interval(0, 10);
  EXPECT_NEAR(none.low, 0.0, 1e-15);
  EXPECT_NEAR(none.high, 0.2775328, 1e-7);
}

/// The bounds solve the equation that defines them.
TEST(Wilson, BoundsAreRootsOfTheScoreEquation) {
  for (std::int64_t n = 1; n <= 40; ++n) {
    for (std::int64_t k = 0; k <= n; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(n);
      const ShareInterval interval = wilson_interval(k, n);
      EXPECT_LE(0.0, interval.low);
      EXPECT_LE(interval.high, 1.0);
      for (const double p : {interval.low, interval.high}) {
        const double reach = kZ95 * std::sqrt(p * (1.0 - p) / static_cast<double>(n));
        const bool at_edge = (k == 0 && p < 1e-12) || (k == n && p > 1.0 - 1e-12);
        if (at_edge) continue;
        EXPECT_NEAR(std::abs(share - p), reach, 1e-12) << k << " of " << n;
      }
    }
  }
}

TEST(Wilson, NothingIsKnownWithoutTrials) {
  EXPECT_EQ(wilson_interval(0, 0).low, 0.0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1.0);
  EXPECT_DOUBLE_EQ(wilson_interval(0, 0).half_width(), 0.5);
}

}  // namespace
}  // namespace overfly::evaluation
