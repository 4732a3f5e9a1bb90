// The risk model: its formulas, and how well the committed coefficients separate the recorded
// flights.
#include "server/experiments/predict/risk_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "evaluation/statistics/roc_area.hpp"
#include "tests/support/support.hpp"

namespace overfly::server::predict {
namespace {

TEST(RiskModel, HazardIsLogistic) {
  RiskModel model;
  model.scale.fill(2.0);
  model.mean.fill(1.0);
  model.bias = -1.0;
  model.weight[3] = 0.5;
  Inputs window{};
  window.fill(1.0);
  EXPECT_NEAR(hazard_of(model, window), 1.0 / (1.0 + std::exp(1.0)), 1e-12);
  window[3] = 5.0;  // two standard deviations
  EXPECT_NEAR(hazard_of(model, window), 0.5, 1e-12);
  EXPECT_NEAR(contributions_of(model, window)[3], 1.0, 1e-12);
  EXPECT_EQ(contributions_of(model, window)[2], 0.0);
}

TEST(RiskModel, RisksOfSecondsMultiply) {
  EXPECT_NEAR(risk_within(0.1, 2.0), 0.19, 1e-12);
  EXPECT_NEAR(risk_within(0.19, 0.5), 0.1, 1e-12);
  const auto risks = risk_so_far({0.1, 0.2, 0.0}, 1.0);
  ASSERT_EQ(risks.size(), 3U);
  EXPECT_NEAR(risks[1], 0.28, 1e-12);
  EXPECT_NEAR(risks[2], 0.28, 1e-12);
  EXPECT_NEAR(risk_so_far({0.19, 0.19}, 0.5).back(), 0.19, 1e-12) << "does not depend on the step";
}

TEST(RiskModel, AWindowIsASecond) {
  std::vector<Inputs> instants(4);
  for (std::size_t k = 0; k < 4; ++k) instants[k].fill(static_cast<double>(k));
  instants[1][8] = 10.0;
  const Inputs window = window_inputs(instants, 3, 0.5);  // instants 1 to 3
  EXPECT_DOUBLE_EQ(window[0], 2.0) << "the mean";
  EXPECT_DOUBLE_EQ(window[8], 10.0) << "the worst blur";
  EXPECT_DOUBLE_EQ(window_inputs(instants, 0, 0.5)[8], 0.0);
  EXPECT_DOUBLE_EQ(window_inputs(instants, 3, 5.0)[0], 3.0) << "instants far apart stand alone";
}

/// The flights of flights.csv: outcome and the model's risk, by set.
struct JudgedFlights {
  std::vector<double> lost;
  std::vector<double> completed;
  std::set<std::string> worlds;
};

std::map<std::string, JudgedFlights> judged_flights() {
  std::istringstream table(overfly::testing::read_text(
      overfly::testing::source_file("tests/server/experiments/predict/flights.csv")));
  std::string line;
  std::getline(table, line);
  std::string head = "set,flight,world,outcome,lost_s,second";
  for (const char* name : kInputNames) head += std::string(",") + name;
  EXPECT_EQ(line, head);
  struct Flight {
    std::string world;
    bool lost = false;
    std::vector<double> hazards;
  };
  std::map<std::pair<std::string, std::string>, Flight> flights;
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string set, number, world, outcome, field;
    std::getline(fields, set, ',');
    std::getline(fields, number, ',');
    std::getline(fields, world, ',');
    std::getline(fields, outcome, ',');
    std::getline(fields, field, ',');
    std::getline(fields, field, ',');
    Inputs window{};
    for (double& value : window) {
      std::getline(fields, field, ',');
      value = std::stod(field);
    }
    Flight& flight = flights[{set, number}];
    flight.world = world;
    flight.lost = outcome != "COMPLETED";
    flight.hazards.push_back(hazard_of(fitted_model(), window));
  }
  std::map<std::string, JudgedFlights> sets;
  for (const auto& [key, flight] : flights) {
    JudgedFlights& judged = sets[key.first];
    judged.worlds.insert(flight.world);
    (flight.lost ? judged.lost : judged.completed)
        .push_back(risk_so_far(flight.hazards, 1.0).back());
  }
  return sets;
}

TEST(RiskModel, SeparatesLostFromCompletedFlightsOverOtherWorlds) {
  const auto sets = judged_flights();
  ASSERT_TRUE(sets.contains("fit") && sets.contains("judge"));
  const JudgedFlights& judged = sets.at("judge");
  for (const std::string& world : judged.worlds) {
    EXPECT_FALSE(sets.at("fit").worlds.contains(world)) << world << " was fitted to";
  }
  EXPECT_GE(judged.lost.size(), 25U);
  EXPECT_GE(judged.completed.size(), 25U);
  const auto area = evaluation::roc_area(judged.lost, judged.completed);
  ASSERT_TRUE(area.has_value());
  // Measured: 0.908 (docs/PREDICT.md).
  EXPECT_GE(*area, 0.9);
  RecordProperty("roc_area_percent", static_cast<int>(100.0 * *area));
}

TEST(RiskModel, StandardisesAsFitted) {
  for (std::size_t i = 0; i < kInputs; ++i) {
    EXPECT_GT(fitted_model().scale[i], 0.0) << kInputNames[i];
    EXPECT_TRUE(std::isfinite(fitted_model().weight[i])) << kInputNames[i];
  }
  EXPECT_LE(fitted_model().weight[0], 0.0) << "finer imagery must not raise the risk";
  EXPECT_LE(fitted_model().weight[1], 0.0) << "more corners must not raise the risk";
}

}  // namespace
}  // namespace overfly::server::predict
