// Tables of a folder of made-up results.
#include "server/experiments/tables/sweep_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiments/tables/table_parts.hpp"
#include "tests/server/experiments/sweep_tables_fixture.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using evaluation::Outcome;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

TEST_F(SweepTablesTest, HighlightsTheLowestAndMarksCellsWithoutACountingFlight) {
  add({"one", 50, 0, 2.0, 0.1});
  add({"two", 50, 0, 1.0, 0.3});
  add({"one", 100, 0, std::nullopt, std::nullopt, Outcome::kNotInitialised});
  add({"two", 100, 0, 4.0, 0.2, Outcome::kLost});
  const std::string text = markdown();
  // Convention paper: held errors, Euler norm, also of the lost flight.
  EXPECT_THAT(text,
              HasSubstr("| 50 | 4.00 | **2.00** |  | **0.150** | 0.450 |  |\n"
                        "| 100 | X | **8.00** |  | X | **0.300** |  |\n"));
  // Convention sim3: only the completed flights.
  EXPECT_THAT(text,
              HasSubstr("| 50 | 0.200 | **0.100** |  | **0.100** | 0.300 |  |\n"
                        "| 100 | X | X |  | X | X |  |\n"));
  EXPECT_THAT(text, HasSubstr("Height [m]"));
  EXPECT_THAT(text, HasSubstr("one rotation [deg]"));
  EXPECT_THAT(text, HasSubstr("# Made \\| up"));
}

TEST_F(SweepTablesTest, MarksErrorsThatTheAlignmentDoesNotDetermine) {
  add({"one", 50, 0, 2.0, 0.1});
  Made hold{"hold", 50, 0, 3.0, 0.2};
  hold.moves = false;
  add(hold);
  const std::string text = markdown();
  EXPECT_THAT(text, HasSubstr("| 50 | **4.00** |  | 6.00 | **0.150** |  | 0.300 |\n"));
  EXPECT_THAT(text, HasSubstr("| 50 | **0.200** |  | - | **0.100** |  | - |\n"));
  EXPECT_THAT(text, HasSubstr("| 50 | hold | 1 COMPLETED | 1 | 100 [21, 100] | - | - |"));
}

TEST_F(SweepTablesTest, AnXEntersNoMedian) {
  add({"one", 50, 0, 1.0, 0.1});
  add({"one", 50, 1, 3.0, 0.1});
  add({"one", 50, 2, std::nullopt, std::nullopt, Outcome::kNotInitialised});
  const SweepTables made = tables();
  ASSERT_EQ(made.rows.size(), 1U);
  EXPECT_EQ(json_from(made).at("rows").at(0).at("errors").at("sim3").at("flights"), 2);
  const CellScores& row = made.rows[0];
  EXPECT_EQ(row.flights, 3);
  EXPECT_EQ(row.initialised, 2);
  EXPECT_EQ(row.completed, 2);
  EXPECT_DOUBLE_EQ(row.errors[1].position_m->quartiles.median, 0.2);
  EXPECT_EQ(row.errors[1].position_m->flights, 2U);
  EXPECT_DOUBLE_EQ(row.errors[1].percent_of_path->quartiles.median, 0.02);
  EXPECT_DOUBLE_EQ(row.errors[1].horizontal_m->quartiles.median, 0.12);
  EXPECT_THAT(markdown(), HasSubstr("0.200 (2/3)"));
  EXPECT_THAT(markdown(), HasSubstr("2 COMPLETED, 1 NOT_INITIALISED"));
}

TEST_F(SweepTablesTest, MarksEstimatorsThatAreOverconfident) {
  const std::vector<double> honest(50, 3.0);
  const std::vector<double> boasting(50, 12.0);
  const Outcome completed = Outcome::kCompleted;
  add({"one", 50, 0, 1.0, 0.1, completed, "process", honest});
  add({"one", 50, 1, 1.0, 0.1, completed, "process", boasting});
  add({"one", 50, 2, 1.0, 0.1, completed, "process", boasting});
  add({"two", 50, 0, 1.0, 0.1});
  const SweepTables made = tables();
  const CellHonesty& honesty = made.rows.at(0).errors[1].honesty;
  EXPECT_EQ(honesty.flights, 3U);
  EXPECT_EQ(honesty.overconfident, 2U);
  EXPECT_EQ(honesty.too_cautious, 0U);
  EXPECT_DOUBLE_EQ(honesty.deviation_ratio->quartiles.median, 2.0);
  EXPECT_THAT(markdown(), HasSubstr("| 50 | one | 3 | 2 | 0 | 2.00 [1.50, 2.00] |\n"));
  EXPECT_THAT(markdown(), Not(HasSubstr("| 50 | two | 0 |")));
  EXPECT_THAT(csv_from(made), HasSubstr("COMPLETED:3,3,2,0,2,,,,,,,0\n"));
  EXPECT_EQ(
      json_from(made).at("rows").at(0).at("errors").at("sim3").at("honesty").at("overconfident"),
      2);
}

TEST_F(SweepTablesTest, ShowsTheDriftBetweenFixesOfLongFlights) {
  const auto flown = [](double median_m, double worst_m) {
    return std::vector<evaluation::FixDrift>{
        {1000.0, 12, 2, median_m, worst_m, 0.0, 0.0, ""},
        {2000.0, 0, 0, 0.0, 0.0, 0.0, 0.0, "the path is shorter than 2000 m"}};
  };
  const Outcome completed = Outcome::kCompleted;
  add({"one", 50, 0, 1.0, 0.1, completed, "process", {}, flown(3.0, 9.5)});
  add({"one", 50, 1, 1.0, 0.1, completed, "process", {}, flown(5.0, 7.0)});
  add({"two", 50, 0, 1.0, 0.1});
  const SweepTables made = tables();
  const auto& drift = made.rows.at(0).errors[1].fix_drift;
  EXPECT_EQ(drift[0].median_m->flights, 2U);
  EXPECT_DOUBLE_EQ(drift[0].median_m->quartiles.median, 4.0);
  EXPECT_DOUBLE_EQ(drift[0].worst_m, 9.5);
  EXPECT_FALSE(drift[1].median_m);
  EXPECT_THAT(markdown(), HasSubstr("Drift between position fixes, convention sim3"));
  EXPECT_THAT(markdown(), HasSubstr("| 50 | one | 4.00 [3.50, 4.50] / 9.50 | - | - |\n"));
  EXPECT_THAT(markdown(), Not(HasSubstr("| 50 | two | -")));
  EXPECT_THAT(csv_from(made), HasSubstr("fix_drift_1000m_median,fix_drift_1000m_worst"));
  EXPECT_THAT(csv_from(made), HasSubstr(",4,9.5,,,,,0\n"));
  const Json json = json_from(made).at("rows").at(0).at("errors").at("sim3").at("fix_drift");
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json.at(0).at("worst_m"), 9.5);
}

TEST_F(SweepTablesTest, HasNoHonestyWithoutCovariances) {
  add({"one", 50, 0, 1.0, 0.1});
  EXPECT_THAT(markdown(), Not(HasSubstr("Honesty")));
  EXPECT_THAT(markdown(), Not(HasSubstr("position fixes")));
  EXPECT_THAT(csv_from(tables()), HasSubstr("COMPLETED:1,0,0,0,,,,,,,,0\n"));
}

TEST_F(SweepTablesTest, TiesAreHighlightedTogether) {
  add({"one", 50, 0, 1.0, 0.1});
  add({"two", 50, 0, 1.0, 0.1});
  EXPECT_THAT(markdown(), HasSubstr("| 50 | **2.00** | **2.00** |"));
}

TEST_F(SweepTablesTest, MarksEstimatorsThatDoNotBeatABaseline) {
  add({"one", 50, 0, 5.0, 0.1});
  add({"two", 50, 0, 1.0, 0.4});
  add({"hold", 50, 0, 4.0, 0.3, Outcome::kCompleted, "baseline_hold"});
  const std::string text = markdown();
  EXPECT_THAT(text, HasSubstr("| 50 | 10.0 † | **2.00** | 8.00 | **0.150** | 0.600 † | 0.450 |"));
  EXPECT_THAT(text, HasSubstr("the best baseline of the cell is at least as good"));
}

TEST_F(SweepTablesTest, AnEstimatorWithoutAValueDoesNotBeatABaselineEither) {
  add({"one", 50, 0, std::nullopt, std::nullopt, Outcome::kNotInitialised});
  add({"two", 50, 0, 1.0, std::nullopt});  // its rotation is not determined
  add({"hold", 50, 0, 4.0, 0.3, Outcome::kCompleted, "baseline_hold"});
  add({"one", 100, 0, std::nullopt, std::nullopt, Outcome::kNotInitialised});
  add({"hold", 100, 0, std::nullopt, std::nullopt, Outcome::kNotInitialised, "baseline_hold"});
  const std::string text = markdown();
  EXPECT_THAT(text, HasSubstr("| 50 | X † | **2.00** | 8.00 | X † | - | **0.450** |"));
  EXPECT_THAT(text, HasSubstr("| 100 | X |  | X | X |  | X |"));
}

TEST_F(SweepTablesTest, SaysWhatAnAlignmentDoesNotDetermine) {
  add({"one", 50, 0, 1.0, std::nullopt});
  add({"two", 50, 0, 1.0, 0.1});
  EXPECT_THAT(markdown(), HasSubstr("| **2.00** | **2.00** |  | - | **0.150** |"));
}

TEST_F(SweepTablesTest, ComparesEstimatorsOnCommonCells) {
  for (int k = 0; k < 12; ++k) {
    add({"one", 50.0 * k, 0, 1.0 + 0.1 * k, 0.1});
    add({"two", 50.0 * k, 0, 1.5 + 0.11 * k, 0.1});
  }
  add({"one", 9000, 0, 1.0, 0.1});
  const SweepTables made = tables();
  const EstimatorDifference& position = made.differences[1].front();
  EXPECT_EQ(position.first, "one");
  EXPECT_EQ(position.second, "two");
  EXPECT_EQ(position.difference.pairs, 12U);
  EXPECT_EQ(position.only_first, 1U);
  EXPECT_EQ(position.verdict, DifferenceVerdict::kFirstBetter);
  EXPECT_LT(position.difference.high, 0.0);
  const auto rotation = std::find_if(made.differences[1].begin(),
                                     made.differences[1].end(),
                                     [](const auto& d) { return d.quantity == "rotation_deg"; });
  EXPECT_EQ(rotation->verdict, DifferenceVerdict::kPracticallyEqual);
  EXPECT_THAT(markdown(), HasSubstr("| one is better |"));
  EXPECT_THAT(markdown(), HasSubstr("practically equal (within 10 %)"));
}

/// Cells and estimators that flew in part of them only keep their places.
TEST_F(SweepTablesTest, ARowBelongsToItsCellAndEstimator) {
  add({"two", 100, 0, 4.0, 0.1});
  add({"one", 50, 0, 1.0, 0.1});
  add({"two", 150, 0, 3.0, 0.1});
  add({"one", 150, 0, 2.0, 0.1});
  const SweepTables made = tables({});
  ASSERT_EQ(made.rows.size(), 4U);
  std::vector<std::string> names;  // by cell
  for (const CellRows& rows : rows_by_cell(made)) {
    std::string& text = names.emplace_back();
    for (const CellScores* row : rows) text += row == nullptr ? "-" : " " + row->estimator;
  }
  EXPECT_THAT(names, ElementsAre(" one--", "- two-", " one two-"));
}

TEST_F(SweepTablesTest, AreCancelled) {
  add({"one", 50, 0, 1.0, 0.1});
  add({"two", 50, 0, 2.0, 0.1});
  Result<SweepScores> scores = read_sweep_scores(folder_);
  ASSERT_TRUE(scores.ok());
  const std::atomic<bool> cancel{true};
  const auto cancelled = sweep_tables(std::move(*scores), {}, &cancel);
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
}

TEST_F(SweepTablesTest, DecidesNothingOnFewCells) {
  for (int k = 0; k < 4; ++k) {
    add({"one", 50.0 * k, 0, 1.0, 0.1});
    add({"two", 50.0 * k, 0, 9.0, 0.1});
  }
  EXPECT_EQ(tables().differences[0].front().verdict, DifferenceVerdict::kTooFewCells);
}

TEST_F(SweepTablesTest, NeedsMoreThanEqualSignsOfFewCells) {
  for (int k = 0; k < 5; ++k) {
    add({"one", 50.0 * k, 0, 1.0 + k, 0.1});
    add({"two", 50.0 * k, 0, 9.0 + k, 0.1});
  }
  // Five differences of one sign happen by chance once in 16 times.
  EXPECT_EQ(tables().differences[0].front().verdict, DifferenceVerdict::kNotDecided);
}

TEST_F(SweepTablesTest, ShowsPublishedErrorsAndWhetherTheOrderIsTheSame) {
  add({"one", 50, 0, 2.0, 0.1});
  add({"two", 50, 0, 1.0, 0.3});
  const fs::path file = folder_ / "published.json";
  std::ofstream(file) << R"({"format_version": 1, "source": "S", "estimators": ["A", "B"], "rows": [
    {"cell": {"h": 50}, "position_m": [10.5, 3.0], "rotation_deg": [null, 2.0]}]})";
  Result<PublishedErrors> published = read_published_errors(file);
  ASSERT_TRUE(published) << published.error().message;
  TableOptions options;
  options.published = *published;
  options.counterparts = {{"one", "A"}, {"two", "B"}};
  const SweepTables made = tables(options);
  ASSERT_EQ(made.orderings[0].size(), 1U);
  EXPECT_EQ(made.orderings[0][0].same, 1U);
  EXPECT_EQ(made.orderings[0][0].cells, 1U);
  EXPECT_EQ(made.orderings[0][0].first_better, 0U);
  EXPECT_THAT(markdown(options), HasSubstr("| 10.5 | 3.00 | X | 2.00 |"));
  options.counterparts = {{"none", "A"}};
  Result<SweepScores> scores = read_sweep_scores(folder_);
  const auto refused = sweep_tables(std::move(*scores), options);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("none: must be an estimator of the sweep"));
}

TEST_F(SweepTablesTest, RefusesPublishedErrorsOfAnotherLength) {
  const fs::path file = folder_ / "published.json";
  std::ofstream(file) << R"({"source": "S", "estimators": ["A", "B"], "rows": [
    {"cell": {"h": 50}, "position_m": [10.5], "rotation_deg": [1, 2]}]})";
  const auto published = read_published_errors(file);
  ASSERT_FALSE(published);
  EXPECT_THAT(published.error().message, HasSubstr("published.json"));
  EXPECT_THAT(published.error().message, HasSubstr("position_m"));
}

TEST_F(SweepTablesTest, EscapesTextInEveryFormat) {
  add({"one", 50, 0, 2.0, 0.1});
  SweepTables made = tables();
  made.scores.title = "<script> & _x_ 5%";
  const TableDocument document = document_from(made, {});
  EXPECT_THAT(html_from(document), Not(HasSubstr("<script>")));
  EXPECT_THAT(html_from(document), HasSubstr("&lt;script&gt; &amp;"));
  EXPECT_THAT(latex_from(document), HasSubstr("\\begin{tabular}{rrrrrrr}"));
  EXPECT_THAT(latex_from(document), HasSubstr("Height [m] & one position [m]"));
  EXPECT_THAT(latex_from(document), HasSubstr("\\midrule\n{}50 & "));
  EXPECT_THAT(csv_from(made), HasSubstr("50,one,paper,1,1,1,"));
}

TEST_F(SweepTablesTest, ComparesTheScaleAtTheStartWithThatOfTheWholeFlight) {
  Made off{"one", 50, 0, 46.8, 0.1};
  off.start_scale = 0.9328;
  add(off);
  off.repeat = 1;
  off.start_scale = 0.9330;
  add(off);
  add({"two", 50, 0, 1.0, 0.1, Outcome::kDiverged});
  const SweepTables made = tables();
  ASSERT_TRUE(made.rows.at(0).start_scale_percent);
  EXPECT_NEAR(made.rows[0].start_scale_percent->quartiles.median, -6.71, 1e-9);
  EXPECT_EQ(made.rows[0].start_scale_percent->flights, 2U);
  EXPECT_FALSE(made.rows.at(1).start_scale_percent) << "of a flight that was not completed";
  EXPECT_THAT(markdown(), HasSubstr("## Scale at the start"));
  EXPECT_THAT(markdown(), HasSubstr("| 50 | -6.71 | - |"));
  EXPECT_THAT(csv_from(made), HasSubstr("start_scale_percent_median\n"));
  EXPECT_THAT(csv_from(made), HasSubstr(",-6.7"));
  const Json rows = json_from(made).at("rows");
  EXPECT_NEAR(rows.at(0).at("start_scale_percent").at("median").get<double>(), -6.71, 1e-9);
  EXPECT_TRUE(rows.at(1).at("start_scale_percent").is_null());
}

TEST_F(SweepTablesTest, HasNoScalesWithoutACompletedFlight) {
  add({"one", 50, 0, 2.0, 0.1, Outcome::kLost});
  EXPECT_THAT(markdown(), Not(HasSubstr("Scale at the start")));
}

TEST(ErrorNumber, HasThreeSignificantDigits) {
  EXPECT_EQ(error_number(0.0), "0");
  EXPECT_EQ(error_number(0.012345), "0.0123");
  EXPECT_EQ(error_number(0.099951), "0.100");
  EXPECT_EQ(error_number(1.2345), "1.23");
  EXPECT_EQ(error_number(9.9999), "10.0");
  EXPECT_EQ(error_number(99.96), "100");
  EXPECT_EQ(error_number(1234.5), "1234");
  EXPECT_EQ(error_number(-0.5), "-0.500");
  EXPECT_EQ(error_number(999999.0), "999999");
  EXPECT_EQ(error_number(2381716801126.0), "2.38e+12");
  EXPECT_EQ(error_number(-1e300), "-1.00e+300");
}

}  // namespace
}  // namespace overfly::server::experiments
