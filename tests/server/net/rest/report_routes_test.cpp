// Reports of the server's runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/report/report.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kGroundPicture = "data:image/jpeg;base64,";

Answer report_of(const TestServer& server, const std::string& query) {
  return ask(server.port(), "GET", "/api/v1/report?runs=" + query);
}

TEST(ReportRoutes, ServeWhatTheCommandWrites) {
  TestServer server;
  const std::string a = server.fly("tiny");
  const std::string b = server.fly("tiny");
  const Answer answer = report_of(server, a + "," + b + "&alignment=sim3");
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.headers.at("content-type"), "text/html; charset=utf-8");
  EXPECT_EQ(answer.headers.at("content-disposition"),
            "inline; filename=\"overfly-report-2-runs.html\"");
  EXPECT_THAT(answer.headers.at("content-security-policy"), HasSubstr("sandbox"));
  EXPECT_THAT(answer.body, HasSubstr(kGroundPicture));
  server::report::ReportOptions options;
  options.alignment = evaluation::AlignmentMode::kSim3;
  const fs::path runs = server.folder() / "runs";
  const auto written = server::report::make_report({runs / a, runs / b}, options);
  ASSERT_TRUE(written.ok());
  EXPECT_TRUE(answer.body == written->html);
  // Another alignment gives other figures.
  EXPECT_FALSE(report_of(server, a + "," + b).body == answer.body);
}

TEST(ReportRoutes, NameWhatIsAtFault) {
  server::RunManagerOptions options;
  options.max_parallel_runs = 2;
  TestServer server(net::ServerOptions(), options);
  const std::string id = server.fly("tiny");
  EXPECT_THAT(report_of(server, "").body, HasSubstr("1 to 16 ids"));
  std::string many = id;
  for (int i = 0; i < 16; ++i) many += "," + id;
  EXPECT_EQ(report_of(server, many).status, 400);
  const Answer twice = report_of(server, id + "," + id);
  EXPECT_EQ(twice.status, 400);
  EXPECT_THAT(twice.body, HasSubstr("each run only once"));
  const Answer mode = report_of(server, id + "&alignment=best");
  EXPECT_EQ(mode.status, 400);
  EXPECT_THAT(mode.body, HasSubstr("query.alignment = best"));
  EXPECT_EQ(report_of(server, id + ",nobody").status, 404);
  EXPECT_EQ(report_of(server, "..%2f..%2fetc").status, 404);
  // A run that is not over is left out, and named, as long as another can be reported.
  const std::string flying = server.start("slow");
  const auto timeline = server.runs().timeline(flying).value();
  for (std::uint64_t seen = 0; timeline->frame_count() == 0;) {
    seen = timeline->wait_for_change(seen, 1000);
  }
  EXPECT_EQ(report_of(server, flying).status, 409);
  const Answer rest = report_of(server, id + "," + flying);
  EXPECT_EQ(rest.status, 200);
  EXPECT_THAT(rest.body, HasSubstr(flying));
}

TEST(ReportRoutes, OpenNoWorldOutsideTheDataFolders) {
  TestServer server;
  const TemporaryFolder elsewhere;
  fs::copy(server.folder() / "world", elsewhere.path() / "world");
  const std::string id = server.fly("tiny");
  ASSERT_THAT(report_of(server, id).body, HasSubstr(kGroundPicture));
  const fs::path file = server::scenario_file(server.folder() / "runs" / id);
  json scenario = server::read_json(file).value();
  json& image = scenario.at("world").at("imagery").at(0).at("file");
  image = (elsewhere.path() / "world" / fs::path(image.get<std::string>()).filename()).string();
  ASSERT_TRUE(fs::exists(image.get<std::string>()));
  ASSERT_TRUE(server::write_json(file, scenario).ok());
  const Answer answer = report_of(server, id);
  EXPECT_EQ(answer.status, 200);
  EXPECT_THAT(answer.body, Not(HasSubstr(kGroundPicture)));
  EXPECT_THAT(answer.body, HasSubstr("Without a picture of the ground"));
}

}  // namespace
}  // namespace overfly::testing
