// Tables and comparisons of the server's sweeps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/net/rest/sweep_routes_fixture.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// Sweeps "seeds" (seeds 1, 2, 3) and "more" (seeds 2, 3, 4) of one estimator.
class SweepTablesRoutesTest : public SweepRoutesTest {
 protected:
  void SetUp() override {
    ASSERT_EQ(start("seeds").status, 201);
    (void)ended("seeds");
    const json axes = json::array({{{"path", "seed"}, {"values", {2, 3, 4}}}});
    ASSERT_EQ(start("more", {{"axes", axes}}).status, 201);
    (void)ended("more");
    fs::create_directories(published());
    write_text(published() / "paper.json", R"({
      "format_version": 1, "source": "A paper", "estimators": ["DSO"],
      "rows": [{"cell": {"seed": 2}, "position_m": [4.25], "rotation_deg": [null]}]})");
  }
  [[nodiscard]] fs::path published() const {
    return server_->folder() / "scenarios/sweeps/published";
  }
  Answer tables(const std::string& query) {
    return ask(server_->port(), "GET", std::string(kSweepRoute) + "/seeds/tables" + query);
  }
  Answer compared(const json& body) {
    return post(std::string(kSweepRoute) + "/seeds/comparison", body);
  }
};

TEST_F(SweepTablesRoutesTest, TablesAreTextsOfEachFormat) {
  const Answer markdown = tables("");
  ASSERT_EQ(markdown.status, 200) << markdown.body;
  EXPECT_EQ(markdown.headers.at("content-type"), "text/markdown; charset=utf-8");
  EXPECT_EQ(markdown.headers.at("content-disposition"), "inline; filename=\"seeds.md\"");
  EXPECT_THAT(markdown.body, HasSubstr("# Three seeds"));
  EXPECT_THAT(markdown.body, HasSubstr("| 3 |"));
  EXPECT_THAT(tables("?format=latex").body, HasSubstr("\\toprule"));
  const Answer html = tables("?format=html");
  EXPECT_EQ(html.headers.at("content-type"), "text/html; charset=utf-8");
  EXPECT_THAT(html.headers.at("content-security-policy"), HasSubstr("sandbox"));
  EXPECT_THAT(html.body, HasSubstr("<table"));
  EXPECT_THAT(tables("?format=csv").body, HasSubstr("perfect"));
  EXPECT_EQ(json::parse(tables("?format=json").body).at("rows").size(), 3U);
  EXPECT_THAT(tables("?format=pdf").body, HasSubstr("query.format = pdf"));
  EXPECT_EQ(tables("?margin_percent=101").status, 400);
  EXPECT_EQ(tables("?margin_percent=nan").status, 400);
}

TEST_F(SweepTablesRoutesTest, PublishedErrorsStandBeside) {
  const json files = ask(server_->port(), "GET", "/api/v1/sweep-files").json();
  EXPECT_EQ(files.at("published"), json({"paper"}));
  EXPECT_THAT(tables("").body, Not(HasSubstr("4.25")));
  const Answer with_published = tables("?published=paper&as=perfect=DSO");
  ASSERT_EQ(with_published.status, 200) << with_published.body;
  EXPECT_THAT(with_published.body, HasSubstr("Published: A paper"));
  EXPECT_THAT(with_published.body, HasSubstr("4.25"));
  EXPECT_EQ(tables("?published=paper&as=perfect=SVO").status, 400);
  EXPECT_EQ(tables("?published=paper&as=perfect").status, 400);
  for (const char* name : {"none", "..%2f..%2fworld", "%2fetc%2fpasswd", "..%2ftiny"}) {
    EXPECT_EQ(tables(std::string("?published=") + name).status, 404) << name;
  }
  write_text(published() / "bad.json", "{}");
  EXPECT_EQ(tables("?published=bad").status, 422);
}

TEST_F(SweepTablesRoutesTest, ComparesTheFlightsThatBothHave) {
  const Answer answer = compared({{"baseline", "more"},
                                  {"conditions",
                                   {"success_rate < 1",
                                    "median(coverage) >= baseline",
                                    "median(rotation_rmse_deg) > baseline / 0"}}});
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json result = answer.json();
  EXPECT_EQ(result.at("pairs"), 2);
  EXPECT_EQ(result.at("without_pair"), 2);
  EXPECT_EQ(result.at("failed"), 0);
  EXPECT_EQ(
      result.at("quantities").at(0),
      (json{{"quantity", "success_rate"}, {"flights", 2}, {"sweep", 1.0}, {"baseline", 1.0}}));
  const json& conditions = result.at("conditions");
  EXPECT_EQ(conditions.at(0).at("holds"), false);
  EXPECT_EQ(conditions.at(1).at("holds"), true) << "equal, which is a failure";
  EXPECT_TRUE(conditions.at(2).at("holds").is_null());
  EXPECT_TRUE(conditions.at(2).at("problem").is_string());
}

TEST_F(SweepTablesRoutesTest, ComparisonsNameWhatIsAtFault) {
  EXPECT_THAT(compared({{"baseline", "more"}, {"conditions", {"success < 1"}}}).body,
              HasSubstr("success"));
  EXPECT_EQ(compared({{"baseline", "more"},
                      {"conditions", std::vector<std::string>(33, "success_rate < 1")}})
                .status,
            400);
  EXPECT_EQ(compared({{"baseline", "more"}, {"conditions", {std::string(501, '(')}}}).status, 400);
  // As deep as a condition may be.
  EXPECT_EQ(compared({{"baseline", "more"}, {"conditions", {std::string(500, '(')}}}).status, 400);
  EXPECT_EQ(compared({{"baseline", "more"}, {"alignment", "best"}}).status, 400);
  EXPECT_EQ(compared({{"baseline", "../runs"}}).status, 404);
  const Answer none = compared({{"baseline", "more"}, {"estimator", "nobody"}});
  EXPECT_EQ(none.status, 404);
  EXPECT_THAT(none.body, HasSubstr("seeds: has no estimator nobody (known: "));
  EXPECT_THAT(none.body, Not(HasSubstr(server_->folder().string())));
}

TEST_F(SweepTablesRoutesTest, AFlightWhoseScoresAreGoneIsNamed) {
  const fs::path runs = server_->folder() / "sweeps/more/runs";
  for (const fs::directory_entry& run : fs::directory_iterator(runs)) {
    fs::remove(run.path() / "metrics.json");
  }
  const Answer gone = compared({{"baseline", "more"}});
  EXPECT_EQ(gone.status, 404) << gone.body;
  EXPECT_THAT(gone.body, HasSubstr("more/runs/"));
  EXPECT_THAT(gone.body, HasSubstr("metrics.json"));
  EXPECT_THAT(gone.body, Not(HasSubstr(server_->folder().string())));
}

TEST_F(SweepTablesRoutesTest, TablesSayWhatIsLeftOut) {
  const fs::path run = fs::directory_iterator(server_->folder() / "sweeps/seeds/runs")->path();
  fs::remove(run / "metrics.json");
  for (const char* format : {"markdown", "latex", "html"}) {
    const Answer answer = tables(std::string("?format=") + format);
    ASSERT_EQ(answer.status, 200) << answer.body;
    EXPECT_THAT(answer.body, HasSubstr("Left out: seeds/runs/")) << format;
    EXPECT_THAT(answer.body, Not(HasSubstr(server_->folder().string()))) << format;
  }
  const json table = ask(server_->port(), "GET", std::string(kSweepRoute) + "/seeds").json();
  EXPECT_EQ(table.at("table").at("unreadable"), 1);
  EXPECT_EQ(table.at("table").at("former_results"), 0);
}

}  // namespace
}  // namespace overfly::testing
