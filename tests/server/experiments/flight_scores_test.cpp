// Which results of a sweep's folder its tables show, and in which order.
#include "server/experiments/tables/flight_scores.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/experiments/sweep_tables_fixture.hpp"

namespace overfly::server::experiments {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class FlightScoresTest : public SweepTablesTest {};

TEST_F(FlightScoresTest, TextsOfAnAxisAreInTheOrderOfTheSweep) {
  std::ofstream(folder_ / "sweep.json")
      << Json{{"axes", Json::array({{{"name", "light"}}, {{"path", "h"}}})},
              {"axis_values", {{"light", {"20 ms", "5 ms", "10 ms"}}, {"h", {50, 100}}}},
              {"estimator_names", {"one"}}};
  for (const char* light : {"10 ms", "5 ms", "20 ms"}) {
    for (const double height_m : {100.0, 50.0}) {
      Made made{"one", height_m, 0, 1.0, 0.1};
      made.light = light;
      add(made);
    }
  }
  std::vector<std::string> order;
  for (const Json& cell : tables().scores.cells) {
    order.push_back(cell.at("light").get<std::string>() + " " + cell.at("h").dump());
  }
  EXPECT_THAT(order,
              ::testing::ElementsAre(
                  "20 ms 50", "20 ms 100", "5 ms 50", "5 ms 100", "10 ms 50", "10 ms 100"));
}

TEST_F(FlightScoresTest, LeavesOutFlightsThatTheSweepNoLongerHas) {
  std::ofstream(folder_ / "sweep.json")
      << Json{{"axes", Json::array({{{"path", "h"}, {"label", "Height"}, {"unit", "m"}}})},
              {"axis_values", {{"h", {50, 100}}}},
              {"repeats", {{"most", 2}}},
              {"skip", Json::array({{{"h", {{"min", 80}}}}})},
              {"estimator_names", {"one"}}};
  add({"one", 50, 0, 1.0, 0.1});
  add({"one", 50, 1, 3.0, 0.1});
  add({"one", 50, 2, 90.0, 0.1});   // a repeat of an earlier version of the sweep
  add({"one", 150, 0, 90.0, 0.1});  // another height
  add({"one", 100, 0, 90.0, 0.1});  // one that is skipped now
  add({"two", 50, 0, 90.0, 0.1});   // another estimator
  const SweepTables made = tables();
  ASSERT_EQ(made.rows.size(), 1U);
  EXPECT_EQ(made.rows[0].estimator, "one");
  EXPECT_EQ(made.rows[0].flights, 2);
  EXPECT_THAT(markdown(), HasSubstr("4 results of flights that the sweep no longer has"));
  EXPECT_TRUE(made.scores.problems.empty()) << "nothing is unreadable";
  EXPECT_EQ(json_from(made).at("former_results"), 4);
}

TEST_F(FlightScoresTest, TakesTheNewestResultOfAFlight) {
  add({"one", 50, 0, 7.0, 0.1}, "z");      // an older version's, with a key that sorts last
  add({"one", 50, 0, 1.0, 0.1}, "a", 77);  // also with another seed of the scenario
  const SweepTables made = tables();
  ASSERT_EQ(made.rows.size(), 1U);
  EXPECT_EQ(made.rows[0].flights, 1);
  EXPECT_DOUBLE_EQ(made.rows[0].errors[1].position_m->quartiles.median, 0.1);
}

TEST_F(FlightScoresTest, LeavesOutRunsThatCannotBeRead) {
  add({"one", 50, 0, 2.0, 0.1});
  add({"one", 100, 0, 2.0, 0.1});
  std::ofstream(folder_ / "runs" / "r1" / "metrics.json") << "{";
  const SweepTables made = tables();
  EXPECT_EQ(made.rows.size(), 1U);
  ASSERT_EQ(made.scores.problems.size(), 1U);
  EXPECT_THAT(made.scores.problems[0], HasSubstr("metrics.json"));
  EXPECT_THAT(latex_from(document_from(made, {})), HasSubstr("\nLeft out: "));
}

}  // namespace
}  // namespace overfly::server::experiments
