// overfly report: the file, its numbers against overfly evaluate, refusals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/server/app/command_line_fixture.hpp"
#include "tests/server/app/program.hpp"

namespace overfly::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// The block of exact numbers.
Json data_in(const std::string& html) {
  const std::string begin = "<script type=\"application/json\" id=\"overfly-report\">";
  const std::size_t from = html.find(begin);
  if (from == std::string::npos) return {};
  const std::size_t start = from + begin.size();
  return Json::parse(html.substr(start, html.find("</script>", start) - start));
}

TEST_F(CommandLine, ReportHasTheNumbersOfEvaluate) {
  SKIP_WITHOUT_EGL();
  ASSERT_EQ(overfly_program({"run", scenario_file(), "--out", path("reported")}).exit_code, 0);
  const Outcome report =
      overfly_program({"report", path("reported"), path("absent"), "--out", path("report.html")});
  ASSERT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(report.out, HasSubstr("report.html: 1 run, "));
  EXPECT_THAT(report.err, HasSubstr("warning: absent is not in the report: "));
  const Json data = data_in(read_text(path("report.html")));
  const Outcome scored =
      overfly_program({"evaluate", "--run", path("reported"), "--alignment", "all", "--json"});
  ASSERT_EQ(scored.exit_code, 0) << scored.err;
  Json evaluated = Json::parse(scored.out);
  EXPECT_EQ(data.at("runs").at(0).at("status"), evaluated.at("status"));
  evaluated.erase("status");
  EXPECT_EQ(data.at("runs").at(0).at("metrics"), evaluated);
}

TEST_F(CommandLine, ReportRefusesWhatItCannotDo) {
  write_text(path("there.html"), "mine");
  const Outcome taken = overfly_program({"report", path("none"), "--out", path("there.html")});
  EXPECT_EQ(taken.exit_code, 2);
  EXPECT_THAT(taken.err, HasSubstr("there.html: exists already"));
  EXPECT_EQ(read_text(path("there.html")), "mine");
  const Outcome absent = overfly_program({"report", path("none"), "--out", path("new.html")});
  EXPECT_EQ(absent.exit_code, 2);
  EXPECT_THAT(absent.err, HasSubstr("none"));
  EXPECT_FALSE(std::filesystem::exists(path("new.html")));
  EXPECT_EQ(
      overfly_program({"report", path("none"), "--out", path("new.html"), "--alignment", "sim4"})
          .exit_code,
      2);
  EXPECT_EQ(overfly_program({"report", "--out", path("new.html")}).exit_code, 2);
}

}  // namespace
}  // namespace overfly::testing
