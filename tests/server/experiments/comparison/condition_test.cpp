// Conditions: grammar, values and errors.
#include "server/experiments/comparison/condition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace overfly::server::experiments {
namespace {

using ::testing::HasSubstr;

const FlightValues kFlights{
    {"success_rate", {1, 1, 0, 1}}, {"position_rmse_m", {3.0, 1.0, 2.0}}, {"coverage", {0.5, 1.0}}};
const FlightValues kBaseline{{"success_rate", {1, 1, 1, 1}}, {"position_rmse_m", {1.0, 1.5, 4.0}}};

Condition::Verdict judged(const std::string& text) {
  const auto condition = Condition::parse(text);
  EXPECT_TRUE(condition.ok()) << (condition.ok() ? "" : condition.error().message);
  const auto verdict = condition->evaluate(kFlights, kBaseline);
  EXPECT_TRUE(verdict.ok()) << (verdict.ok() ? "" : verdict.error().message);
  return *verdict;
}

std::string fault_of(const std::string& text) {
  const auto condition = Condition::parse(text);
  if (!condition) return condition.error().message;
  const auto verdict = condition->evaluate(kFlights, kBaseline);
  return verdict ? "" : verdict.error().message;
}

TEST(Condition, ComparesQuantitiesOfTheFlights) {
  EXPECT_TRUE(judged("success_rate < 0.95").holds);
  EXPECT_DOUBLE_EQ(judged("success_rate < 0.95").left, 0.75);
  EXPECT_FALSE(judged("success_rate < 0.75").holds);
  EXPECT_TRUE(judged("success_rate <= 0.75").holds);
  EXPECT_TRUE(judged("success_rate >= 0.75").holds);
  EXPECT_FALSE(judged("success_rate > 0.75").holds);
  EXPECT_DOUBLE_EQ(judged("median(position_rmse_m) > 0").left, 2.0);
  EXPECT_DOUBLE_EQ(judged("mean(position_rmse_m) > 0").left, 2.0);
  EXPECT_DOUBLE_EQ(judged("min(position_rmse_m) > 0").left, 1.0);
  EXPECT_DOUBLE_EQ(judged("max(position_rmse_m) > 0").left, 3.0);
}

TEST(Condition, TheBaselineIsTheSameQuantityOfTheOtherFlights) {
  const auto verdict = judged("median(position_rmse_m) > 1.1 * baseline");
  EXPECT_TRUE(verdict.holds);
  EXPECT_DOUBLE_EQ(verdict.right, 1.1 * 1.5);
  EXPECT_DOUBLE_EQ(judged("success_rate < baseline - 0.1").right, 0.9);
  EXPECT_DOUBLE_EQ(judged("2 * max(position_rmse_m) < baseline").right, 4.0);
}

TEST(Condition, TheMedianOfTwoFlightsIsTheirMean) {
  const auto condition = Condition::parse("median(position_rmse_m) > 1.1 * baseline");
  ASSERT_TRUE(condition);
  const auto verdict =
      condition->evaluate({{"position_rmse_m", {1.0, 9.0}}}, {{"position_rmse_m", {1.0, 1.0}}});
  ASSERT_TRUE(verdict);
  EXPECT_DOUBLE_EQ(verdict->left, 5.0);
  EXPECT_TRUE(verdict->holds);
}

TEST(Condition, OperatorsBindAsInArithmetic) {
  EXPECT_DOUBLE_EQ(judged("1 + 2 * 3 > 0").left, 7.0);
  EXPECT_DOUBLE_EQ(judged("(1 + 2) * 3 > 0").left, 9.0);
  EXPECT_DOUBLE_EQ(judged("8 - 2 - 1 > 0").left, 5.0);
  EXPECT_DOUBLE_EQ(judged("8 / 2 / 2 > 0").left, 2.0);
  EXPECT_DOUBLE_EQ(judged("1e-3+0.5*2 > 0").left, 1.001);
}

TEST(Condition, NamesWhatIsWrong) {
  EXPECT_THAT(fault_of("success_rate"), HasSubstr("must have <, <=, > or >= at position 13"));
  EXPECT_THAT(fault_of("success < 1"), HasSubstr("success_rate, baseline"));
  EXPECT_THAT(fault_of("median(speed) < 1"), HasSubstr("position_rmse_m, "));
  EXPECT_THAT(fault_of("median(coverage < 1"), HasSubstr("\")\" at position 17"));
  EXPECT_THAT(fault_of("coverage < 1"), HasSubstr("position 1"));
  EXPECT_THAT(fault_of("success_rate < 1 2"), HasSubstr("its end at position 18"));
  EXPECT_THAT(fault_of("baseline < 1"), HasSubstr("baseline must be on the right"));
  EXPECT_THAT(fault_of("1 < baseline"), HasSubstr("baseline must be on the right"));
  EXPECT_THAT(fault_of("mean(coverage) / success_rate < baseline"), HasSubstr("of one quantity"));
  EXPECT_THAT(fault_of("mean(coverage) < baseline"), HasSubstr("baseline: coverage: no flight"));
  EXPECT_THAT(fault_of("mean(reset_count) < 1"), HasSubstr("reset_count: no flight has a value"));
  EXPECT_THAT(fault_of("success_rate / 0 < 1"), HasSubstr("gives no finite number"));
  EXPECT_THAT(fault_of("1e999 < 1"), HasSubstr("a number"));
  EXPECT_THAT(fault_of(""), HasSubstr("position 1"));
  EXPECT_THAT(fault_of(std::string(900, '(') + "1"), HasSubstr("at most 20 nested"));
  EXPECT_THAT(fault_of(std::string(2000, '1')), HasSubstr("at most 1000 characters"));
}

}  // namespace
}  // namespace overfly::server::experiments
