// What smoothing leaves of a log's samples, over REST, and how far the smoothing is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "server/net/rest/progress_board.hpp"
#include "tests/flight/logs/northward_log.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(LogResiduals, AreTablesOfUsedAndOfOtherSamples) {
  TestServer server;
  std::string log = northward_log();
  // Sample 30 is 0.001 deg, 111 m, to the north of its place. A record has 29 bytes.
  const std::size_t record = log.size() - 20 * 29;
  std::int32_t lat = 0;
  std::memcpy(&lat, &log[record + 11], sizeof lat);
  lat += 10'000;
  std::memcpy(&log[record + 11], &lat, sizeof lat);
  write_text(server.folder() / "logs" / "a.bin", log);
  const std::string place = "/api/v1/logs/logs%2Fa.bin/residuals";
  const Answer answer = ask(server.port(), "GET", place + "?progress=abcdefgh-1");
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json residuals = answer.json();
  const json& positions = residuals.at("positions");
  EXPECT_EQ(positions.at("source"), "SIM");
  EXPECT_EQ(positions.at("used_count"), 49);
  EXPECT_EQ(positions.at("left_out_count"), 1);
  EXPECT_EQ(positions.at("used").at("t_s").size(), 49U);
  EXPECT_LT(positions.at("rms_m").get<double>(), 0.05);
  const json& left_out = positions.at("left_out");
  EXPECT_NEAR(left_out.at("t_s").at(0).get<double>(), 2.2, 1e-9);
  EXPECT_NEAR(left_out.at("north_m").at(0).get<double>(), 111.2, 0.5);
  EXPECT_NEAR(left_out.at("east_m").at(0).get<double>(), 0.0, 0.1);
  EXPECT_EQ(residuals.at("attitudes").at("used_count"), 50);
  EXPECT_EQ(residuals.at("attitudes").at("used").at("x_deg").size(), 50U);
  EXPECT_EQ(residuals.at("time_offset_sigma_s"), nullptr);
  EXPECT_EQ(residuals.at("jump_count"), 1);
  EXPECT_THAT(residuals.at("jumps").at(0).at("text").get<std::string>(),
              HasSubstr("1 position left out at 2.200 s"));
  // Over when it is answered.
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/progress/abcdefgh-1").status, 404);
}

TEST(LogResiduals, SayWhatIsWrongWithARequest) {
  TestServer server;
  write_text(server.folder() / "logs" / "a.bin", northward_log());
  const std::string place = "/api/v1/logs/logs%2Fa.bin/residuals";
  for (const char* query : {"?time_offset_s=3",
                            "?time_offset_s=nan",
                            "?time_offset_s=",
                            "?points=7",
                            "?progress=short",
                            "?progress=abcdefgh%2F1",
                            "?source=GPS"}) {
    EXPECT_EQ(ask(server.port(), "GET", place + query).status, 400) << query;
  }
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/logs/logs%2Fb.bin/residuals").status, 404);
  // A flight without turns does not determine the offset; less than 5 samples are no flight.
  EXPECT_EQ(ask(server.port(), "GET", place + "?time_offset_s=auto").status, 422);
  EXPECT_EQ(ask(server.port(), "GET", place + "?from_s=2.95").status, 422);
}

TEST(ProgressBoard, KnowsWorkAsLongAsItGoesOn) {
  const auto board = std::make_shared<net::ProgressBoard>();
  EXPECT_FALSE(board->find("a").has_value());
  auto work = net::ProgressBoard::begin(board, "a");
  ASSERT_NE(work, nullptr);
  EXPECT_EQ(board->find("a")->step, "waiting");
  EXPECT_EQ(net::ProgressBoard::begin(board, "a"), nullptr);
  work->set("positions", 0.5);
  EXPECT_EQ(board->find("a")->step, "positions");
  EXPECT_EQ(board->find("a")->share, 0.5);
  std::vector<std::shared_ptr<net::ProgressBoard::Entry>> others;
  for (int i = 0; i < 100; ++i) {
    others.push_back(net::ProgressBoard::begin(board, "b" + std::to_string(i)));
  }
  EXPECT_EQ(others[62] != nullptr, true);
  EXPECT_EQ(others[63], nullptr);
  work->end();
  EXPECT_FALSE(board->find("a").has_value());
  // Its name may be used again, and is then not its own.
  const auto next = net::ProgressBoard::begin(board, "a");
  ASSERT_NE(next, nullptr);
  work->set("positions", 0.7);
  work.reset();
  EXPECT_EQ(board->find("a")->step, "waiting");
}

}  // namespace
}  // namespace overfly::testing
