// Calibrations over REST, from the first image to the file for another program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "server/files/jpeg.hpp"
#include "tests/server/calibration/board_fixture.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kSessions = "/api/v1/calibration-sessions";
const json kBoard = {{"cols", 9}, {"rows", 6}, {"square_m", 0.03}};

class CalibrationRoutes : public ::testing::Test {
 protected:
  Answer post(const std::string& target, const json& body) {
    return ask(server_.port(), "POST", target, body.dump(), kJson);
  }
  Answer begin(const json& source, const json& board = kBoard) {
    return post(kSessions, {{"source", source}, {"board", board}});
  }
  /// Waits for a session's state.
  json wait_for(const std::string& session, const std::function<bool(const json&)>& condition) {
    json state;
    for (int turns = 0; turns < 3000; ++turns) {
      state = ask(server_.port(), "GET", session).json();
      if (condition(state)) return state;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ADD_FAILURE() << state.dump(2);
    return state;
  }
  TestServer server_;
};

TEST_F(CalibrationRoutes, NameTheFieldThatIsWrong) {
  const auto message = [&](const json& body) {
    const Answer answer = post(kSessions, body);
    EXPECT_EQ(answer.status, 400) << answer.body;
    return answer.body;
  };
  const json upload = {{"kind", "upload"}};
  EXPECT_THAT(message({{"board", kBoard}}), HasSubstr("source"));
  EXPECT_THAT(message({{"source", {{"kind", "file"}}}, {"board", kBoard}}),
              HasSubstr("source.kind"));
  EXPECT_THAT(message({{"source", {{"kind", "folder"}}}, {"board", kBoard}}),
              HasSubstr("source.name"));
  EXPECT_THAT(message({{"source", upload}, {"board", {{"cols", 9}, {"rows", 6}}}}),
              HasSubstr("board.square_m"));
  EXPECT_THAT(
      message({{"source", upload}, {"board", {{"cols", 2}, {"rows", 6}, {"square_m", 1}}}}),
      HasSubstr("board.cols = 2: must be an integer in [3, 60]"));
  EXPECT_THAT(
      message({{"source", upload}, {"board", {{"cols", 7}, {"rows", 7}, {"square_m", 1}}}}),
      HasSubstr("half a turn"));
  json charuco = kBoard;
  charuco["markers"] = "7x7";
  charuco["marker_m"] = 0.02;
  EXPECT_THAT(message({{"source", upload}, {"board", charuco}}), HasSubstr("board.markers"));
  EXPECT_THAT(message({{"source", upload}, {"board", kBoard}, {"model", "fov"}}),
              HasSubstr("model"));
  EXPECT_THAT(
      message({{"source", upload}, {"board", kBoard}, {"model", "equidistant"}, {"k3", true}}),
      HasSubstr("k3"));
  EXPECT_THAT(message({{"source", upload}, {"board", kBoard}, {"modle", "radtan"}}),
              HasSubstr("modle"));
  const json scenario = {{"kind", "scenario"}, {"name", "tiny"}, {"views", 3}};
  EXPECT_THAT(message({{"source", scenario}, {"board", kBoard}}), HasSubstr("source.views = 3"));
  EXPECT_EQ(ask(server_.port(), "GET", kSessions).json(), json({{"sessions", json::array()}}));
}

TEST_F(CalibrationRoutes, RefuseSourcesOutsideOfWhatTheServerOffers) {
  for (const json& source : {json{{"kind", "folder"}, {"name", "/etc"}},
                             json{{"kind", "folder"}, {"name", "world/../../etc"}},
                             json{{"kind", "recording"}, {"name", "/etc/passwd"}},
                             json{{"kind", "scenario"}, {"name", "../tiny"}},
                             json{{"kind", "camera"}, {"name", "http://127.0.0.1:1/x"}}}) {
    EXPECT_EQ(begin(source).status, 404) << source;
  }
  EXPECT_EQ(begin({{"kind", "scenario"}, {"name", "tiny"}, {"camera", "none"}}).status, 400);
}

TEST_F(CalibrationRoutes, AnswerOnlyWhatHasChanged) {
  const std::string session = begin({{"kind", "upload"}}).headers.at("location");
  const json state = wait_for(session, [](const json& now) { return now.at("phase") == "taking"; });
  const std::string revision = std::to_string(state.at("revision").get<int>());
  const Answer same = ask(server_.port(), "GET", session + "?revision=" + revision);
  EXPECT_EQ(same.status, 204);
  EXPECT_TRUE(same.body.empty());
  EXPECT_EQ(post(session + "/control", {{"automatic", false}}).status, 202);
  const Answer changed = ask(server_.port(), "GET", session + "?revision=" + revision);
  EXPECT_EQ(changed.status, 200);
  EXPECT_EQ(changed.json().at("automatic"), false);
  EXPECT_EQ(ask(server_.port(), "GET", session + "?revision=x").status, 400);
}

TEST_F(CalibrationRoutes, RefuseImagesThatAreTooLargeOrNotWanted) {
  const std::string session = begin({{"kind", "upload"}}).headers.at("location");
  const std::string images = session + "/images";
  EXPECT_EQ(ask(server_.port(), "POST", images, "x").status, 400);
  EXPECT_EQ(ask(server_.port(), "POST", images + "?name=a%0Ab", "x").status, 400);
  const Answer large =
      ask(server_.port(), "POST", images + "?name=a", std::string((32U << 20U) + 1, 'x'));
  EXPECT_EQ(large.status, 413);
  EXPECT_EQ(ask(server_.port(), "POST", kSessions + "/none/images?name=a", "x").status, 404);
  int refused = 0;
  for (int i = 0; i < 40; ++i) {
    const Answer answer = ask(server_.port(), "POST", images + "?name=a", "no image");
    if (answer.status == 429) ++refused;
  }
  const json state =
      wait_for(session, [&](const json& now) { return now.at("images") == 40 - refused; });
  EXPECT_EQ(state.at("views").size(), 0U);
  const json board = {{"cols", 4}, {"rows", 3}, {"square_m", 0.03}};
  const json virtual_board = {{"kind", "scenario"}, {"name", "tiny"}};
  const std::string other = begin(virtual_board, board).headers.at("location");
  EXPECT_EQ(ask(server_.port(), "POST", other + "/images?name=a", "x").status, 409);
}

TEST_F(CalibrationRoutes, ASavedCalibrationIsFlown) {
  const std::string session = begin({{"kind", "upload"}}).headers.at("location");
  for (const Image& image : server::testing::board_images(6)) {
    const auto jpeg = server::encode_jpeg(image, 95).value();
    const std::string body(jpeg.begin(), jpeg.end());
    while (ask(server_.port(), "POST", session + "/images?name=a.jpg", body).status == 429) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  post(session + "/control", {{"finish", true}});
  wait_for(session, [](const json& now) { return now.at("solution").is_number(); });
  const json solution = ask(server_.port(), "GET", session + "/solution").json();
  const std::string id = session.substr(session.rfind('/') + 1);
  const Answer saved = post("/api/v1/calibrations", {{"session", id}, {"name", "front"}});
  ASSERT_EQ(saved.status, 201) << saved.body;
  EXPECT_EQ(saved.headers.at("location"), "/api/v1/calibrations/front");

  const json overrides = {{"camera", {{"calibration", saved.json().at("file")}, {"rate_hz", 31}}},
                          {"duration_s", 0.2}};
  const Answer run = post("/api/v1/runs", {{"scenario", "tiny"}, {"overrides", overrides}});
  ASSERT_EQ(run.status, 201) << run.body;
  const std::string run_id = run.json().at("id");
  server_.wait_for_end(run_id);
  const json manifest =
      ask(server_.port(), "GET", "/api/v1/runs/" + run_id + "/manifest").json();
  EXPECT_EQ(manifest.at("cameras")[0].at("fx_px"), solution.at("fx_px"));
  EXPECT_EQ(manifest.at("cameras")[0].at("width_px"), 480);

  for (const auto& [format, type] : std::map<std::string, std::string>{
           {"orb-slam2", "application/yaml"},
           {"dso", "text/plain; charset=utf-8"},
           {"svo", "application/yaml"},
           {"ros", "application/yaml"},
           {"kalibr", "application/yaml"}}) {
    const Answer file = ask(server_.port(), "GET", "/api/v1/calibrations/front?format=" + format);
    EXPECT_EQ(file.status, 200) << format;
    EXPECT_EQ(file.headers.at("content-type"), type);
    EXPECT_THAT(file.headers.at("content-disposition"), HasSubstr("front-" + format));
  }
  const Answer other = ask(server_.port(), "GET", "/api/v1/calibrations/front?format=mat");
  EXPECT_EQ(other.status, 400);
  EXPECT_THAT(other.body, HasSubstr("orb-slam2, dso, svo, ros or kalibr"));
}

TEST(CalibrationRoutesOff, NothingIsSavedWithoutUploads) {
  net::ServerLimits limits;
  limits.uploads.quota_bytes = 0;
  TestServer server(limits);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/calibrations").json().at("keeps"), false);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/calibration-sources").json().at("keeps"), false);
}

}  // namespace
}  // namespace overfly::testing
