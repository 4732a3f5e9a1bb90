// Reports of damaged and hostile runs, and their limits.
#include "server/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_lock.hpp"
#include "tests/server/report/whole_report.hpp"

namespace overfly::server::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::read_text;
using overfly::testing::write_text;
using testing::data_of;
using testing::Element;
using testing::expect_self_contained;
using ::testing::HasSubstr;
using testing::made;
using testing::Markup;
using ::testing::Not;
using testing::read_markup;

using ReportFaults = testing::ReportTest;

TEST_F(ReportFaults, NamesRunsThatCannotBeReported) {
  const fs::path broken = copy("broken");
  write_text(CameraFiles::of_main_camera(broken).rows(), "{\"frame\": \"<b>\"}\n");
  const fs::path empty = copy("empty");
  write_text(CameraFiles::of_main_camera(empty).rows(), "");
  const fs::path running = copy("running");
  Json manifest = *read_json(manifest_file(running));
  manifest["status"] = "running";
  ASSERT_TRUE(write_json(manifest_file(running), manifest).ok());
  const auto lock = RunLock::take(running);
  ASSERT_TRUE(lock.ok());
  const MadeReport report = made({broken, run_folder(), empty, running, own() / "absent"});
  EXPECT_EQ(report.runs, 1U);
  ASSERT_EQ(report.left_out.size(), 4U);
  EXPECT_THAT(report.left_out[0].reason, HasSubstr("frames.jsonl"));
  EXPECT_THAT(report.left_out[1].reason, HasSubstr("no frames"));
  EXPECT_THAT(report.left_out[2].reason, HasSubstr("running"));
  EXPECT_EQ(report.left_out[3].name, "absent");
  expect_self_contained(report.html);
  EXPECT_THAT(report.html, HasSubstr("Not in this report"));
  EXPECT_EQ(data_of(report.html).at("left_out").size(), 4U);
  const auto none = make_report({own() / "absent"});
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().code, ErrorCode::kNotFound);
}

TEST_F(ReportFaults, SaysWhyThereIsNoPictureOfTheGround) {
  const fs::path run = copy();
  Json scenario = *read_json(scenario_file(run));
  scenario["world"] = {{"manifest", "/nowhere/<world>.json"}};
  ASSERT_TRUE(write_json(scenario_file(run), scenario).ok());
  const std::string html = made({run}).html;
  expect_self_contained(html);
  EXPECT_TRUE(read_markup(html).named("image").empty());
  EXPECT_THAT(html, HasSubstr("Without a picture of the ground: /nowhere/&lt;world&gt;.json"));
  EXPECT_THAT(html, HasSubstr("Map of the tracks"));
}

/// Texts of a run folder from somebody else.
TEST_F(ReportFaults, ShowsHostileTextsAsTexts) {
  const std::string hostile =
      "</script><script>alert(1)</script>\"'><img src=x onerror=alert(2)> ]]> -->\x01&amp;";
  const fs::path run = copy("<script>\"'&\xFF");
  Json manifest = *read_json(manifest_file(run));
  manifest["title"] = hostile;
  manifest["version"] = hostile;
  manifest["error"] = hostile;
  manifest["world"]["attribution"] = hostile;
  manifest["world"]["warnings"] = {hostile};
  manifest["flight"]["description"] = hostile;
  manifest["renderer"]["device"] = hostile;
  manifest["estimators"][0]["parameters"] = {{hostile, hostile}};
  ASSERT_TRUE(write_json(manifest_file(run), manifest).ok());
  Json scenario = *read_json(scenario_file(run));
  scenario["description"] = hostile;
  scenario[hostile] = hostile;
  ASSERT_TRUE(write_json(scenario_file(run), scenario).ok());
  const Json line = {{"t_ns", 1}, {"level", "error"}, {"text", hostile}, {"source", hostile}};
  const Json odd = {{"t_ns", 1}, {"level", "warning"}, {"text", std::string(100'000, '<')}};
  write_text(log_file(run), line.dump() + "\n" + odd.dump() + "\n");
  const MadeReport report = made({run, run_folder(), own() / ("no<b>\xFE")});
  expect_self_contained(report.html);
  const Markup markup = read_markup(report.html);
  EXPECT_TRUE(markup.named("img").empty());
  bool shown = false;
  for (const Element& item : markup.named("li")) {
    shown = shown || item.text.find("<script>alert(1)</script>\"'>") != std::string::npos;
  }
  EXPECT_TRUE(shown);
  EXPECT_THAT(report.html, Not(HasSubstr("\xFF")));
  EXPECT_THAT(report.html, Not(HasSubstr("\x01")));
  EXPECT_LT(report.html.size(), 4'000'000U);
  // The data is whole in spite of them.
  EXPECT_EQ(data_of(report.html).at("runs").size(), 2U);
}

/// Rows that are valid numbers and no flight.
TEST_F(ReportFaults, DrawsAnyNumbers) {
  for (const double far_m : {1e12, 1e300, 1.7e308}) {
    const fs::path run = copy("far" + std::to_string(std::log10(far_m)));
    std::string rows;
    double sign = 1.0;
    const auto lines = read_lines(CameraFiles::of_main_camera(run).rows());
    ASSERT_TRUE(lines.ok());
    for (Json row : *lines) {
      row["T_world_camera"]["p_m"] = {sign * far_m, -sign * far_m, far_m};
      row["texels_per_pixel"]["median"] = far_m;
      sign = -sign;
      rows += row.dump() + "\n";
    }
    write_text(CameraFiles::of_main_camera(run).rows(), rows);
    const auto report = make_report({run});
    if (!report) {
      EXPECT_THAT(report.error().message, HasSubstr("frames.jsonl"));
      continue;
    }
    expect_self_contained(report->html);
    for (const Element& path : read_markup(report->html).named("path")) {
      EXPECT_THAT(path.attribute("d"), Not(HasSubstr("nan")));
      EXPECT_THAT(path.attribute("d"), Not(HasSubstr("inf")));
    }
  }
}

TEST_F(ReportFaults, HasLimits) {
  ReportOptions options;
  options.max_bytes = 10'000;
  const auto large = make_report({run_folder()}, options);
  ASSERT_FALSE(large.ok());
  EXPECT_EQ(large.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(large.error().message, HasSubstr("larger than"));
  options = {};
  options.max_rows = 100;  // 21 frames and twice as many answers are one run
  const MadeReport full = made({run_folder(), run_folder()}, options);
  EXPECT_EQ(full.runs, 1U);
  ASSERT_EQ(full.left_out.size(), 1U);
  EXPECT_THAT(
      full.left_out[0].reason,
      HasSubstr("its 63 frames and answers, with 63 of the runs before it, are more than 100"));
  options.max_rows = 10;
  EXPECT_FALSE(make_report({run_folder()}, options).ok());
  EXPECT_FALSE(make_report({}).ok());
  const auto many = make_report(std::vector<fs::path>(kMaxRuns + 1, run_folder()));
  ASSERT_FALSE(many.ok());
  EXPECT_THAT(many.error().message, HasSubstr("runs = 33: must be 1 to 32"));
  const std::atomic<bool> cancel = true;
  options = {};
  options.cancel = &cancel;
  const auto cancelled = make_report({run_folder()}, options);
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
}

TEST_F(ReportFaults, NeverReplacesAFile) {
  const fs::path file = own() / "report.html";
  ASSERT_TRUE(check_report_file(file).ok());
  ASSERT_TRUE(write_report(file, "<p>").ok());
  EXPECT_EQ(read_text(file), "<p>");
  const Status again = write_report(file, "<b>");
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().code, ErrorCode::kConflict);
  EXPECT_FALSE(check_report_file(file).ok());
  EXPECT_EQ(read_text(file), "<p>");
  EXPECT_FALSE(write_report(own() / "none" / "r.html", "<p>").ok());
  // Nothing unfinished stays.
  EXPECT_EQ(std::distance(fs::directory_iterator(own()), fs::directory_iterator()), 1);
  fs::create_symlink("nowhere", own() / "link.html");
  EXPECT_FALSE(check_report_file(own() / "link.html").ok());
}

}  // namespace
}  // namespace overfly::server::report
