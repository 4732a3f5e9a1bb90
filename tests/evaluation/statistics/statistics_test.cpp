// Statistics against what SciPy and R say (record_reference.py).
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "evaluation/statistics/chi_square.hpp"
#include "evaluation/statistics/paired_bootstrap.hpp"
#include "evaluation/statistics/sample_quantile.hpp"

namespace overfly::evaluation {
namespace {

nlohmann::json reference() {
  std::ifstream file(OVERFLY_SOURCE_DIR "/tests/evaluation/statistics/statistics_reference.json");
  return nlohmann::json::parse(file);
}

TEST(SampleQuantile, AgreesWithNumPy) {
  const nlohmann::json cases = reference().at("quantiles");
  for (const auto& entry : cases) {
    EXPECT_NEAR(sample_quantile(entry.at("values"), entry.at("share")),
                entry.at("quantile").get<double>(),
                1e-12)
        << entry;
  }
}

TEST(ChiSquare, AgreesWithSciPy) {
  const nlohmann::json cases = reference().at("chi_square");
  ASSERT_EQ(cases.size(), 28U);
  for (const auto& entry : cases) {
    const auto expected = entry.at("quantile").get<double>();
    EXPECT_NEAR(
        chi_square_quantile(entry.at("share"), entry.at("degrees")), expected, 1e-10 * expected)
        << entry;
  }
}

TEST(Holm, AgreesWithR) {
  const nlohmann::json cases = reference().at("holm");
  for (const auto& entry : cases) {
    const std::vector<double> adjusted = holm_adjusted(entry.at("p"));
    const std::vector<double> expected = entry.at("adjusted");
    ASSERT_EQ(adjusted.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-12);
  }
  EXPECT_TRUE(holm_adjusted({}).empty());
}

TEST(PairedBootstrap, AgreesWithSciPy) {
  const nlohmann::json cases = reference().at("bootstrap");
  for (const auto& entry : cases) {
    const PairedDifference difference = paired_bootstrap(entry.at("a"), entry.at("b"));
    EXPECT_NEAR(difference.median, entry.at("median").get<double>(), 1e-12);
    // 10 000 resamples against 400 000: the medians lie on a grid of steps up to 0.015.
    EXPECT_NEAR(difference.low, entry.at("low").get<double>(), 0.0051) << entry;
    EXPECT_NEAR(difference.high, entry.at("high").get<double>(), 0.0051) << entry;
  }
}

TEST(PairedBootstrap, FindsADifferenceAndFindsNoneWhereThereIsNone) {
  const nlohmann::json cases = reference().at("bootstrap");
  EXPECT_LT(paired_bootstrap(cases[0].at("a"), cases[0].at("b")).p_value, 0.001);
  EXPECT_GT(paired_bootstrap(cases[1].at("a"), cases[1].at("b")).p_value, 0.2);
  const PairedDifference same = paired_bootstrap({1.0, 2.0, 3.0}, {1.0, 2.0, 3.0});
  EXPECT_EQ(same.median, 0.0);
  EXPECT_EQ(same.p_value, 1.0);
}

/// Of pairs without a difference, about one in twenty has an interval without 0.
TEST(PairedBootstrap, IsRarelyWrongAboutPairsThatDoNotDiffer) {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  int wrong = 0;
  constexpr int kSamples = 400;
  for (int k = 0; k < kSamples; ++k) {
    std::vector<double> a;
    std::vector<double> b;
    for (int i = 0; i < 24; ++i) {
      const double common = 10.0 * normal(generator);
      a.push_back(common + normal(generator));
      b.push_back(common + normal(generator));
    }
    const PairedDifference difference = paired_bootstrap(a, b, {1000, 5});
    wrong += difference.low > 0.0 || difference.high < 0.0 ? 1 : 0;
  }
  // Binomial(400, 0.05) has a standard deviation of 4.4; the percentile interval of 24 pairs is a
  // little too short.
  EXPECT_GT(wrong, 5);
  EXPECT_LT(wrong, 40);
}

/// The resamples of few differences of one sign are all on its side, which happens by chance.
TEST(PairedBootstrap, IsRarelyWrongAboutFewPairs) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  constexpr int kSamples = 1000;
  for (const int pairs : {2, 5, 6, 8}) {
    int wrong = 0;
    for (int k = 0; k < kSamples; ++k) {
      std::vector<double> a;
      for (int i = 0; i < pairs; ++i) a.push_back(normal(generator));
      const PairedDifference difference =
          paired_bootstrap(a, std::vector<double>(a.size(), 0.0), {400, 5});
      EXPECT_GE(difference.p_value, std::exp2(1 - pairs));
      wrong += difference.p_value <= 0.05 ? 1 : 0;
    }
    // Binomial(1000, 0.05) has a standard deviation of 7; the interval of few pairs is too short.
    EXPECT_LT(wrong, 90) << pairs;
  }
  EXPECT_EQ(paired_bootstrap({1.0}, {0.0}).p_value, 1.0) << "one pair says nothing";
}

TEST(PairedBootstrap, IsTheSameForTheSameSeed) {
  const nlohmann::json cases = reference().at("bootstrap");
  const PairedDifference first = paired_bootstrap(cases[0].at("a"), cases[0].at("b"));
  const PairedDifference again = paired_bootstrap(cases[0].at("a"), cases[0].at("b"));
  EXPECT_EQ(first.low, again.low);
  EXPECT_EQ(first.p_value, again.p_value);
}

}  // namespace
}  // namespace overfly::evaluation
