// Several runs over one WebSocket: one clock, the place of each run on it, its series.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr std::int64_t kOneSecond = 1'000'000'000;

json playback_of(WebSocketClient& client, std::size_t run_count) {
  return client.wait_until([&](const json& message) {
    return message.at("type") == "playback" && message.at("runs").size() == run_count;
  });
}

TEST(WebSocketRuns, PlayOnOneClock) {
  TestServer server;
  const std::string first = server.fly("tiny");
  const std::string second = server.fly("tiny");
  WebSocketClient client(server.port());
  client.command({{"type", "watch"}, {"run", first}});
  client.command({{"type", "watch"}, {"run", second}, {"offset_ns", kOneSecond}});
  json playback = playback_of(client, 2);
  EXPECT_EQ(playback.at("begin_ns"), 0);
  const std::int64_t end_ns = playback.at("runs").at(first).at("end_ns");
  EXPECT_EQ(playback.at("end_ns"), end_ns + kOneSecond);
  EXPECT_EQ(playback.at("runs").at(second).at("offset_ns"), kOneSecond);
  client.command({{"type", "seek"}, {"t_ns", kOneSecond + kOneSecond / 2}});
  playback = playback_of(client, 2);
  EXPECT_EQ(playback.at("runs").at(first).at("t_ns"), kOneSecond + kOneSecond / 2);
  EXPECT_EQ(playback.at("runs").at(second).at("t_ns"), kOneSecond / 2);
  EXPECT_EQ(playback.at("runs").at(second).at("frame"), 15);
  client.command({{"type", "seek"}, {"run", second}, {"frame", 0}});
  playback = playback_of(client, 2);
  EXPECT_EQ(playback.at("t_ns"), kOneSecond);
  EXPECT_EQ(playback.at("runs").at(first).at("frame"), 31);
  client.command({{"type", "step"}, {"run", second}, {"frames", 3}});
  EXPECT_EQ(playback_of(client, 2).at("runs").at(second).at("frame"), 3);
  // Beyond its end a run stays at its last frame.
  client.command({{"type", "seek"}, {"t_ns", 100 * kOneSecond}});
  playback = playback_of(client, 2);
  EXPECT_EQ(playback.at("runs").at(first).at("frame"), 62);
  EXPECT_EQ(playback.at("runs").at(second).at("frame"), 62);

  client.command({{"type", "watch"}, {"run", second}, {"offset_ns", -2 * kOneSecond}});
  playback = playback_of(client, 2);
  EXPECT_EQ(playback.at("begin_ns"), -2 * kOneSecond);
  EXPECT_EQ(playback.at("end_ns"), end_ns);
  client.command({{"type", "unwatch"}, {"run", second}});
  EXPECT_EQ(playback_of(client, 1).at("begin_ns"), 0);
}

TEST(WebSocketRuns, PlayBackwardsInARange) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  client.command({{"type", "watch"}, {"run", id}});
  client.command({{"type", "range"}, {"begin_ns", kOneSecond / 2}, {"end_ns", kOneSecond}});
  client.command({{"type", "seek"}, {"t_ns", kOneSecond}});
  client.command({{"type", "speed"}, {"value", -20}});
  client.command({{"type", "play"}});
  const json stopped = client.wait_until([](const json& message) {
    return message.at("type") == "playback" && message.at("speed") == -20.0 &&
           !message.at("playing") && message.at("t_ns") < kOneSecond;
  });
  EXPECT_EQ(stopped.at("t_ns"), kOneSecond / 2);
  EXPECT_EQ(stopped.at("range").at("end_ns"), kOneSecond);
}

TEST(WebSocketRuns, SendEachRunsRowsAndPicturesApart) {
  TestServer server;
  const std::string first = server.fly("tiny");
  const std::string second = server.fly("tiny");
  WebSocketClient client(server.port());
  client.command({{"type", "subscribe"},
                  {"pictures",
                   {{{"run", first}, {"name", "camera"}}, {{"run", second}, {"name", "camera"}}}}});
  client.command({{"type", "watch"}, {"run", first}});
  client.command({{"type", "watch"}, {"run", second}, {"offset_ns", kOneSecond}});
  std::map<std::uint32_t, std::string> runs;
  const json pictures = client.wait_for("pictures");
  for (const json& picture : pictures.at("pictures")) runs[picture.at("id")] = picture.at("run");
  ASSERT_EQ(runs.size(), 2U);
  client.command({{"type", "seek"}, {"run", second}, {"frame", 20}});
  std::set<std::string> seen;
  while (seen.size() < 2) {
    const PictureMessage picture = client.wait_for_picture([&](const PictureMessage& message) {
      const bool is_second = runs.at(message.header.stream_id) == second;
      return message.header.frame == (is_second ? 20 : 51);
    });
    seen.insert(runs.at(picture.header.stream_id));
  }
  std::map<std::string, std::size_t> rows;
  for (const json& message : client.texts()) {
    if (message.at("type") != "rows" || message.at("stream") != "truth") continue;
    rows[message.at("run")] += message.at("columns").at("frame").size();
  }
  EXPECT_EQ(rows, (std::map<std::string, std::size_t>{{first, 63U}, {second, 63U}}));
}

TEST(WebSocketRuns, SayWhatCanBePlotted) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  client.command({{"type", "watch"}, {"run", id}});
  const json series = client.wait_for("series");
  EXPECT_EQ(series.at("run"), id);
  const auto find = [&](const std::string& stream, const std::string& column) {
    for (const json& entry : series.at("series")) {
      if (entry.at("stream") == stream && entry.at("column") == column) return entry;
    }
    return json();
  };
  EXPECT_EQ(find("truth", "roll_deg").at("unit"), "deg");
  EXPECT_EQ(find("truth", "exposure_ns").at("scale"), 1e-6);
  const json error = find("estimate/perfect", "error_m");
  EXPECT_EQ(error.at("unit"), "m");
  EXPECT_EQ(error.at("label"), "position error");
  EXPECT_TRUE(find("vehicle", "battery_v").is_null());
  playback_of(client, 1);
  for (const json& message : client.texts()) {
    if (message.at("type") != "rows" || message.at("stream") != "estimate/perfect") continue;
    for (const json& value : message.at("columns").at("error_m")) EXPECT_LT(value, 1e-3);
  }
}

TEST(WebSocketRuns, HaveALimit) {
  TestServer server;
  WebSocketClient client(server.port());
  std::vector<std::string> ids;
  for (int i = 0; i < 17; ++i) ids.push_back(server.fly("tiny"));
  for (int i = 0; i < 16; ++i) {
    ASSERT_EQ(client.command({{"type", "watch"}, {"run", ids[i]}}).at("type"), "ok") << i;
  }
  const json refused = client.command({{"type", "watch"}, {"run", ids[16]}});
  EXPECT_EQ(refused.at("code"), "conflict");
  EXPECT_THAT(refused.at("message").get<std::string>(), HasSubstr("16 runs are watched"));
  client.command({{"type", "unwatch"}, {"run", ids[3]}});
  EXPECT_EQ(client.command({{"type", "watch"}, {"run", ids[16]}}).at("type"), "ok");
}

}  // namespace
}  // namespace overfly::testing
