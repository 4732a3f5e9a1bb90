// What whole reports of small runs say.
#include "server/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_records.hpp"
#include "server/report/best_values.hpp"
#include "server/report/run/read_run.hpp"
#include "server/report/run/words.hpp"
#include "server/scoring/metrics.hpp"
#include "server/scoring/run_metrics_json.hpp"
#include "server/timeline/estimate_errors.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"
#include "tests/server/report/whole_report.hpp"

namespace overfly::server::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::write_text;
using testing::data_of;
using testing::Element;
using testing::expect_self_contained;
using testing::fly;
using ::testing::HasSubstr;
using testing::made;
using testing::Markup;
using ::testing::Not;
using testing::read_markup;

using Report = testing::ReportTest;

void expect_near(const Json& a, const Json& b, const std::string& path) {
  ASSERT_EQ(a.is_number(), b.is_number()) << path;
  if (a.is_number()) {
    EXPECT_NEAR(a.get<double>(), b.get<double>(), 1e-9) << path;
  } else if (a.is_structured()) {
    ASSERT_EQ(a.size(), b.size()) << path;
    const Json flat_a = a.flatten();
    const Json flat_b = b.flatten();
    for (const auto& [key, value] : flat_a.items()) {
      ASSERT_TRUE(flat_b.contains(key)) << path << key;
      if (!value.is_structured()) expect_near(value, flat_b.at(key), path + key);
    }
  } else {
    EXPECT_EQ(a, b) << path;
  }
}

TEST_F(Report, HasTheNumbersOfEvaluate) {
  const MadeReport report = made({run_folder()});
  EXPECT_EQ(report.runs, 1U);
  EXPECT_EQ(report.estimators, 2U);
  EXPECT_TRUE(report.left_out.empty());
  const Json data = data_of(report.html);
  const Json& run = data.at("runs").at(0);
  const auto records = read_run_records(run_folder());
  ASSERT_TRUE(records.ok());
  expect_near(run.at("metrics"), json_from(metrics_from(*records)), "metrics");
  expect_near(run.at("metrics"), *read_json(metrics_file(run_folder())), "metrics.json");
  // The parts in the axes of the path belong to the same errors.
  const Json& alignments = run.at("metrics").at("estimators").at("d").at("alignments");
  ASSERT_GT(alignments.size(), 3U);
  for (const auto& [mode, alignment] : alignments.items()) {
    const Json& axes = run.at("axes").at("d").at(mode);
    EXPECT_NEAR(std::hypot(axes.at("horizontal_rmse_m").get<double>(),
                           axes.at("vertical_rmse_m").get<double>()),
                alignment.at("position_rmse_m").get<double>(),
                1e-9);
    EXPECT_NEAR(axes.at("percent_of_path").get<double>() *
                    run.at("metrics").at("flight").at("path_length_m").get<double>(),
                100.0 * alignment.at("position_rmse_m").get<double>(),
                1e-9);
  }
  EXPECT_GT(run.at("latency").at("d").at("median_ms").get<double>(), 0.0);
  // What is printed is the same, rounded.
  char printed[40];
  std::snprintf(printed,
                sizeof printed,
                "%.4g",
                alignments.at("init_scale").at("position_rmse_m").get<double>());
  EXPECT_THAT(report.html, HasSubstr("<td class=\"n\">" + std::string(printed)));
  // Of the estimator "d": how the best fit's scale differs from the one that is shown.
  const double shown = alignments.at("init_scale").at("scale").get<double>();
  const double fitted = alignments.at("sim3").at("scale").get<double>();
  const std::string change = figure_text(100.0 * std::abs(fitted / shown - 1.0)) + " % " +
                             (fitted < shown ? "less" : "more");
  EXPECT_THAT(report.html, HasSubstr(figure_text(fitted) + ", " + change + ") leaves "));
}

/// The dashboard's errors over time are those of the report, by every alignment.
TEST_F(Report, HasTheErrorsThatViewersAreSent) {
  const auto timeline = RunTimeline::open(run_folder());
  ASSERT_TRUE(timeline.ok());
  for (const auto mode : evaluation::all_alignment_modes()) {
    const auto run = read_report_run(run_folder(), mode);
    ASSERT_TRUE(run.ok());
    for (std::size_t i = 0; i < run->estimates.size(); ++i) {
      const auto alignment = RowAlignment::of(**timeline, i, evaluation::to_string(mode));
      if (!alignment) continue;
      const std::vector<EstimateRow> rows = (*timeline)->estimates(i, 0, 10'000);
      const auto sent = errors_of(**timeline, i, rows, *alignment);
      const std::vector<evaluation::AxisError>& shown = run->estimates[i].axis_errors;
      std::size_t next = 0;
      for (std::size_t k = 0; k < rows.size(); ++k) {
        if (!sent[k]) continue;
        ASSERT_LT(next, shown.size());
        EXPECT_EQ(shown[next].t_ns, rows[k].sample.t_ns);
        EXPECT_NEAR(shown[next].along_m, sent[k]->position.along_m, 1e-9) << k;
        EXPECT_NEAR(shown[next].across_m, sent[k]->position.across_m, 1e-9) << k;
        EXPECT_NEAR(shown[next].up_m, sent[k]->position.up_m, 1e-9) << k;
        ++next;
      }
      EXPECT_EQ(next, shown.size());
      EXPECT_GT(next, 15U);
    }
  }
}

TEST_F(Report, IsOneFileThatLoadsNothing) {
  const std::string html = made({run_folder()}).html;
  expect_self_contained(html);
  const Markup markup = read_markup(html);
  ASSERT_EQ(markup.named("image").size(), 1U);  // the ground
  EXPECT_THAT(html, HasSubstr("Content-Security-Policy\" content=\"default-src 'none'"));
  // Everything drawn has a text alternative, and ids are unique.
  for (const Element& svg : markup.named("svg")) {
    EXPECT_EQ(svg.attribute("role"), "img");
    EXPECT_NE(svg.attribute("aria-labelledby"), "");
  }
  EXPECT_EQ(markup.named("svg").size(), markup.named("desc").size());
  EXPECT_GE(markup.named("svg").size(), 12U);
  std::map<std::string, int> ids;
  for (const Element& element : markup.elements) {
    if (!element.attribute("id").empty()) ++ids[element.attribute("id")];
  }
  for (const auto& [id, count] : ids) EXPECT_EQ(count, 1) << id;
  for (const Element& link : markup.named("a")) {
    EXPECT_EQ(ids.count(link.attribute("href").substr(1)), 1U) << link.attribute("href");
  }
}

/// Test estimators are given the truth: their errors are no achievement.
TEST_F(Report, HasNoBestAmongTestEstimators) {
  const std::string html = made({run_folder()}).html;
  EXPECT_THAT(html, HasSubstr("Only test estimators."));
  EXPECT_THAT(html, Not(HasSubstr("\xE2\x98\x85")));
  EXPECT_THAT(html, Not(HasSubstr("has the smallest position error")));
}

/// A new map has another origin and scale: the scored map's alignment does not apply to it.
TEST_F(Report, ShowsOnlyTheScoredMap) {
  const fs::path run = copy();
  const auto lines = read_lines(estimate_file(run, "d"));
  ASSERT_TRUE(lines.ok());
  std::string rows;
  for (std::size_t i = 0; i < lines->size(); ++i) {
    Json row = (*lines)[i];
    if (i + 5 >= lines->size()) row["map_id"] = 1;
    rows += row.dump() + "\n";
  }
  write_text(estimate_file(run, "d"), rows);
  const auto whole = read_report_run(run_folder(), evaluation::AlignmentMode::kSim3);
  const auto read = read_report_run(run, evaluation::AlignmentMode::kSim3);
  ASSERT_TRUE(whole.ok() && read.ok());
  const ReportEstimate& estimate = read->estimates.at(1);
  ASSERT_EQ(estimate.name, "d");
  EXPECT_EQ(estimate.axis_errors.size() + 5, whole->estimates.at(1).axis_errors.size());
  for (std::size_t i = 0; i < estimate.answers.size(); ++i) {
    const bool in_map = i + 5 < estimate.answers.size();
    EXPECT_EQ(estimate.answers[i].scored, in_map) << i;
    EXPECT_EQ(estimate.answers[i].T_world_body.has_value(), in_map) << i;
  }
}

/// Of an estimator that claims to be a millimetre exact, and drifts.
TEST_F(Report, MarksAnOverconfidentEstimator) {
  const fs::path run = copy();
  const auto lines = read_lines(estimate_file(run, "d"));
  ASSERT_TRUE(lines.ok());
  std::string rows;
  for (Json row : *lines) {
    if (row.contains("T_vo_camera")) row["covariance"] = {1e-6, 0.0, 0.0, 1e-6, 0.0, 1e-6};
    rows += row.dump() + "\n";
  }
  write_text(estimate_file(run, "d"), rows);
  const std::string html = made({run}).html;
  EXPECT_THAT(html, HasSubstr("Honesty of the covariances that estimators state"));
  EXPECT_THAT(html, HasSubstr("<td>overconfident"));
  EXPECT_THAT(html, HasSubstr("It is overconfident: its errors of the position are "));
  EXPECT_EQ(data_of(html)
                .at("runs")
                .at(0)
                .at("metrics")
                .at("estimators")
                .at("d")
                .at("alignments")
                .at("init_scale")
                .at("consistency")
                .at("honesty"),
            "overconfident");
  EXPECT_THAT(made({run_folder()}).html, Not(HasSubstr("Honesty")));
}

TEST_F(Report, WarnsOfAFlightWithoutImagery) {
  const std::string warning =
      "no imagery: in 100 % of the frames more than half of the image of the camera is without "
      "imagery";
  EXPECT_THAT(made({run_folder()}).html, Not(HasSubstr("no imagery:")));
  const fs::path run = copy();
  const auto lines = read_lines(run / "frames.jsonl");
  ASSERT_TRUE(lines.ok());
  std::string rows;
  for (Json row : *lines) {
    row["void_fraction"] = 0.75;
    rows += row.dump() + "\n";
  }
  write_text(run / "frames.jsonl", rows);
  EXPECT_THAT(made({run}).html, HasSubstr(warning));
}

TEST_F(Report, TellsWhyThereIsNoDriftBetweenFixes) {
  const std::string html = made({run_folder()}).html;
  EXPECT_THAT(html, HasSubstr("Drift between position fixes"));
  EXPECT_THAT(html, HasSubstr("1, 2, 5"));
  EXPECT_THAT(html, HasSubstr("X: the scored path is "));
}

TEST_F(Report, OfTheSameRunIsTheSameByteByByte) {
  EXPECT_EQ(made({run_folder()}).html, made({run_folder()}).html);
}

TEST_F(Report, ComparesRunsAndSaysWhatDiffers) {
  fly(own() / "b", {"estimators.1.parameters.drift=0.1"});
  fly(own() / "c", {"flight.course.height_agl_m=150"});
  const std::string html = made({run_folder(), own() / "b", own() / "c"}).html;
  expect_self_contained(html);
  EXPECT_THAT(html, HasSubstr("<h2>What differs between the runs</h2>"));
  EXPECT_THAT(html,
              HasSubstr(R"(<th scope="row">parameters.d.drift</th><td>0.02</td><td>0.1</td>)"));
  EXPECT_THAT(html, HasSubstr(R"(<th scope="row">scenario.flight.course.height_agl_m</th>)"));
  // The first two flew the same way.
  EXPECT_THAT(html, HasSubstr("<h2>One flight: run 1, run 2</h2>"));
  EXPECT_THAT(html, HasSubstr("<h2>The flight of run 3</h2>"));
  EXPECT_EQ(data_of(html).at("runs").size(), 3U);
  EXPECT_THAT(made({run_folder()}).html, Not(HasSubstr("What differs")));
}

/// An interrupted run is scored up to its end; a metrics.json that says something else is named.
TEST_F(Report, ScoresTheRowsItself) {
  const fs::path run = copy();
  fs::remove(metrics_file(run));
  Json manifest = *read_json(manifest_file(run));
  manifest["status"] = "running";
  ASSERT_TRUE(write_json(manifest_file(run), manifest).ok());
  const std::string html = made({run}).html;
  EXPECT_THAT(html, HasSubstr("the run is interrupted"));
  EXPECT_THAT(html, HasSubstr("no readable metrics.json"));
  EXPECT_EQ(data_of(html).at("runs").at(0).at("status"), "interrupted");

  const fs::path other = copy("other");
  Json metrics = *read_json(metrics_file(other));
  metrics["estimators"]["d"]["alignments"]["init_scale"]["position_rmse_m"] = 0.001;
  ASSERT_TRUE(write_json(metrics_file(other), metrics).ok());
  const std::string changed = made({other}).html;
  EXPECT_THAT(changed, HasSubstr("metrics.json has other scores"));
  EXPECT_GT(data_of(changed)
                .at("runs")
                .at(0)
                .at("metrics")
                .at("estimators")
                .at("d")
                .at("alignments")
                .at("init_scale")
                .at("position_rmse_m")
                .get<double>(),
            0.01);
  EXPECT_THAT(made({run_folder()}).html, Not(HasSubstr("metrics.json has other")));
}

/// Every alignment can be shown, whether the flight determines it or not.
TEST_F(Report, CanBeByAnyAlignment) {
  for (const evaluation::AlignmentMode mode : evaluation::all_alignment_modes()) {
    ReportOptions options;
    options.alignment = mode;
    const std::string html = made({run_folder()}, options).html;
    EXPECT_EQ(read_markup(html).fault, "");
    EXPECT_EQ(data_of(html).at("alignment"), evaluation::to_string(mode));
  }
}

TEST(BestValues, AreOfThoseThatTakePart) {
  const auto none = std::optional<double>();
  EXPECT_EQ(best_of({3.0, 1.0, none, 1.0}, false), (std::vector<bool>{0, 1, 0, 1}));
  EXPECT_EQ(best_of({3.0, 1.0, none}, true), (std::vector<bool>{1, 0, 0}));
  EXPECT_EQ(best_of({none, 1.0, std::nan("")}, false), (std::vector<bool>{0, 0, 0}));
  EXPECT_TRUE(best_of({}, false).empty());
}

}  // namespace
}  // namespace overfly::server::report
