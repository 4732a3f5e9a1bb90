// Playback over WebSocket: rows, cursor, pictures, live and replay.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "server/files/jpeg.hpp"
#include "server/timing/picture_rate.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;

constexpr std::int64_t kFrame = 1'000'000'000 / 31;

bool is_playback(const json& message) { return message.at("type") == "playback"; }

/// Rows of each data stream that a client has, counted by message; checks that none is missing.
std::map<std::string, std::size_t> rows_of(const WebSocketClient& client) {
  std::map<std::string, std::size_t> rows;
  for (const json& message : client.texts()) {
    if (message.at("type") != "rows") continue;
    const std::string stream = message.at("stream");
    if (rows.contains(stream)) {
      EXPECT_EQ(message.at("seq"), rows[stream]) << stream;
    } else {
      rows[stream] = message.at("seq");
    }
    rows[stream] += message.at("columns").at("t_ns").size();
  }
  return rows;
}

TEST(WebSocketPlayback, SendsAFinishedRunCompletelyAndWaitsAtItsStart) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  EXPECT_EQ(client.command({{"type", "watch"}, {"run", id}}).at("type"), "ok");
  const json playback = client.wait_until(is_playback);
  EXPECT_EQ(playback.at("t_ns"), 0);
  EXPECT_EQ(run_in(playback).at("frame"), 0);
  EXPECT_EQ(playback.at("playing"), false);
  EXPECT_EQ(playback.at("live"), false);
  EXPECT_TRUE(run_in(playback).at("truth").contains("roll_deg"));
  EXPECT_TRUE(run_in(playback).at("estimates").contains("perfect"));
  const auto rows = rows_of(client);
  EXPECT_EQ(rows.at("truth"), 63U);
  EXPECT_EQ(rows.at("estimate/perfect"), 63U);
  EXPECT_GE(rows.at("log"), 1U);
  std::set<std::string> types;
  for (const json& message : client.texts()) types.insert(message.at("type"));
  EXPECT_TRUE(types.contains("run"));
  EXPECT_TRUE(types.contains("pictures"));
  EXPECT_TRUE(types.contains("metrics"));
  // Sent before the metrics.
  json status_message;
  for (const json& message : client.texts()) {
    if (message.at("type") == "estimators") status_message = message;
  }
  ASSERT_TRUE(status_message.is_object());
  const json status = status_message.at("estimators").at("perfect");
  EXPECT_EQ(status.at("answered"), 63);
  EXPECT_EQ(status.at("dropped"), 0);
  EXPECT_TRUE(status.at("crash").is_null());
  EXPECT_GE(status.at("latency_ms").at("p99"), status.at("latency_ms").at("median"));
}

TEST(WebSocketPlayback, ResumesAfterTheRowsThatTheClientHas) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  client.command({{"type", "watch"}, {"run", id}, {"resume", {{"truth", 60}}}});
  client.wait_until(is_playback);
  for (const json& message : client.texts()) {
    if (message.at("type") == "rows" && message.at("stream") == "truth") {
      EXPECT_EQ(message.at("seq"), 60);
      EXPECT_EQ(message.at("columns").at("frame").front(), 60);
    }
  }
  EXPECT_EQ(rows_of(client).at("truth"), 63U);
}

TEST(WebSocketPlayback, SeeksStepsAndChangesSpeedWithoutTouchingOtherViewers) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  WebSocketClient other(server.port());
  for (WebSocketClient* each : {&client, &other}) {
    each->command({{"type", "watch"}, {"run", id}});
    each->wait_until(is_playback);
  }
  client.command({{"type", "seek"}, {"t_ns", kFrame + kFrame / 2}});
  json playback = client.wait_until(is_playback);
  EXPECT_EQ(playback.at("t_ns"), kFrame + kFrame / 2);
  EXPECT_EQ(run_in(playback).at("frame"), 1);
  const json rows =
      ask(server.port(), "GET", "/api/v1/runs/" + id + "/trajectories/truth?format=json").json();
  const double y_1 = rows.at("y_m").at(1);
  const double y_2 = rows.at("y_m").at(2);
  // Half way between two frames; the wire has millimetres.
  EXPECT_NEAR(run_in(playback).at("truth").at("y_m"), 0.5 * (y_1 + y_2), 2e-3);
  client.command({{"type", "seek"}, {"frame", 40}});
  EXPECT_EQ(run_in(client.wait_until(is_playback)).at("frame"), 40);
  client.command({{"type", "step"}, {"frames", -3}});
  EXPECT_EQ(run_in(client.wait_until(is_playback)).at("frame"), 37);
  client.command({{"type", "step"}, {"frames", 1000}});
  EXPECT_EQ(run_in(client.wait_until(is_playback)).at("frame"), 62);
  client.command({{"type", "speed"}, {"value", 50}});
  EXPECT_EQ(client.wait_until(is_playback).at("speed"), 50.0);
  client.command({{"type", "play"}});
  // From the start again; the end is reached after 1/25 s.
  playback = client.wait_until(
      [](const json& message) { return is_playback(message) && !message.at("playing"); });
  EXPECT_EQ(run_in(playback).at("frame"), 62);
  other.command({{"type", "step"}, {"frames", 1}});
  EXPECT_EQ(run_in(other.wait_until(is_playback)).at("frame"), 1);
}

TEST(WebSocketPlayback, SendsEveryStreamThePictureOfTheRequestedTime) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  client.command(
      {{"type", "subscribe"},
       {"pictures",
        {{{"run", id}, {"name", "camera"}}, {{"run", id}, {"name", "scene"}, {"max_hz", 15}}}}});
  client.command({{"type", "view"}, {"width_px", 96}, {"height_px", 64}, {"distance_m", 50}});
  client.command({{"type", "watch"}, {"run", id}});
  const json pictures = client.wait_for("pictures");
  std::map<std::uint32_t, std::string> names;
  for (const json& picture : pictures.at("pictures")) names[picture.at("id")] = picture.at("name");
  ASSERT_EQ(names.size(), 2U);
  for (const std::int64_t frame : {30, 10, 62, 0}) {
    client.command({{"type", "seek"}, {"frame", frame}});
    std::set<std::string> seen;
    while (seen.size() < 2) {
      const PictureMessage picture = client.wait_for_picture(
          [&](const PictureMessage& message) { return message.header.frame == frame; });
      seen.insert(names.at(picture.header.stream_id));
      const auto image = server::decode_jpeg(picture.jpeg);
      ASSERT_TRUE(image);
      EXPECT_EQ(image->width_px, picture.header.width_px);
      EXPECT_EQ(image->channels == 1, picture.header.encoding == net::PictureEncoding::kJpegGrey);
      const bool is_scene = names.at(picture.header.stream_id) == "scene";
      EXPECT_EQ(image->width_px, is_scene ? 96 : 64);
    }
  }
  std::map<std::uint32_t, std::uint32_t> next;
  for (const PictureMessage& picture : client.pictures()) {
    EXPECT_EQ(picture.header.sequence, next[picture.header.stream_id]++);
  }
}

TEST(WebSocketPlayback, FollowsALiveRunAndLeavesItByASeek) {
  TestServer server;
  const std::string id = server.start("slow");
  WebSocketClient client(server.port());
  client.command({{"type", "subscribe"}, {"pictures", {{{"run", id}, {"name", "camera"}}}}});
  client.command({{"type", "watch"}, {"run", id}});
  const auto live_beyond = [](std::int64_t frame) {
    return [frame](const json& message) {
      return is_playback(message) && message.at("live") && run_in(message).at("frame") > frame;
    };
  };
  client.wait_until(live_beyond(5));
  client.wait_until(live_beyond(15));
  const PictureMessage live =
      client.wait_for_picture([](const PictureMessage& message) { return message.header.live; });
  EXPECT_GE(live.header.frame, 0);
  client.command({{"type", "seek"}, {"frame", 2}});
  client.command({{"type", "pause"}});
  const json paused = client.wait_until(
      [](const json& message) { return is_playback(message) && !message.at("playing"); });
  EXPECT_EQ(paused.at("live"), false);
  client.wait_for_picture([&](const PictureMessage& message) {
    return message.header.frame == run_in(paused).at("frame") && !message.header.live;
  });
  client.command({{"type", "live"}});
  client.wait_until(live_beyond(15));
  ASSERT_EQ(ask(server.port(), "POST", "/api/v1/runs/" + id + "/cancel").status, 202);
  client.wait_until([](const json& message) {
    return message.at("type") == "run" && message.at("run").at("status") == "cancelled";
  });
  const json end = client.wait_until(
      [](const json& message) { return is_playback(message) && !message.at("live"); });
  EXPECT_EQ(end.at("t_ns"), end.at("end_ns"));
  EXPECT_EQ(client.command({{"type", "live"}}).at("code"), "conflict");
}

TEST(WebSocketPlayback, ShowsEstimatesByTheRequestedAlignment) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  const json align = {{"type", "align"}, {"run", id}, {"mode", "sim3"}};
  EXPECT_EQ(client.command(align).at("code"), "conflict");
  client.command({{"type", "watch"}, {"run", id}});
  EXPECT_EQ(run_in(client.wait_until(is_playback)).at("alignment"), "init_scale");
  EXPECT_EQ(client.command({{"type", "align"}, {"run", id}, {"mode", "sim4"}}).at("code"),
            "invalid_argument");
  // With `none` the estimate is in its own frame, which differs from the world.
  EXPECT_EQ(client.command({{"type", "align"}, {"run", id}, {"mode", "none"}}).at("type"), "ok");
  client.command({{"type", "seek"}, {"frame", 40}});
  const auto at_40 = [](const json& message) {
    return is_playback(message) && run_in(message).at("frame") == 40;
  };
  json playback = client.wait_until(at_40);
  EXPECT_EQ(run_in(playback).at("alignment"), "none");
  const json columns =
      ask(server.port(),
          "GET",
          "/api/v1/runs/" + id + "/trajectories/perfect?format=json&alignment=none")
          .json();
  EXPECT_EQ(run_in(playback)["estimates"]["perfect"]["pose"]["z_m"], columns["z_m"][40]);
  EXPECT_GT(
      std::abs(run_in(playback)["truth"]["z_m"].get<double>() - columns["z_m"][40].get<double>()),
      10.0);
  client.command(align);
  playback = client.wait_until(at_40);
  EXPECT_EQ(run_in(playback).at("alignment"), "sim3");
  EXPECT_NEAR(run_in(playback)["estimates"]["perfect"]["pose"]["z_m"],
              run_in(playback)["truth"]["z_m"],
              0.05);
  client.command({{"type", "unwatch"}, {"run", id}});
  client.command({{"type", "watch"}, {"run", id}});
  EXPECT_EQ(run_in(client.wait_until(is_playback)).at("alignment"), "init_scale");
}

TEST(WebSocketPlayback, NumbersAStreamByItsRunAndCamera) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  const auto number_of = [&](const json& stream) {
    EXPECT_EQ(
        client.command({{"type", "subscribe"}, {"pictures", json::array({stream})}}).at("type"),
        "ok");
    const json listed = client.wait_for("pictures").at("pictures").at(0);
    EXPECT_EQ(listed.value("camera", ""), stream.value("camera", ""));
    return listed.at("id").get<int>();
  };
  const int first = number_of({{"run", id}, {"name", "camera"}});
  EXPECT_NE(number_of({{"run", id}, {"name", "camera"}, {"camera", "tail"}}), first);
  EXPECT_EQ(number_of({{"run", id}, {"name", "camera"}}), first);
  EXPECT_NE(number_of({{"run", "other"}, {"name", "camera"}}), first);
  const json scene = {{"run", id}, {"name", "scene"}, {"camera", "tail"}};
  EXPECT_EQ(client.command({{"type", "subscribe"}, {"pictures", json::array({scene})}}).at("code"),
            "invalid_argument");
}

TEST(WebSocketPlayback, ReportsThePictureRateDuringARealTimeFlight) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  const json pictures = {{{"run", id}, {"name", "camera"}, {"max_hz", 31}},
                         {{"run", id}, {"name", "scene"}, {"max_hz", 2}}};
  client.command({{"type", "subscribe"}, {"pictures", pictures}});
  const auto limit_is = [](auto camera_hz) {
    return [camera_hz](const json& message) {
      return message.at("type") == "pictures" && camera_hz(message["pictures"][0]["limit_hz"]) &&
             message["pictures"][0]["max_hz"] == 31.0 && message["pictures"][1]["limit_hz"] == 2.0;
    };
  };
  const auto wanted = limit_is([](const json& hz) { return hz == 31.0; });
  // The rate then depends on the load of the machine.
  const auto lowered = limit_is([](const json& hz) { return hz < 31.0; });
  client.wait_until(wanted);
  client.command({{"type", "watch"}, {"run", id}});
  // The report may come before the answer to the command.
  const std::size_t before = client.texts().size();
  server.runs().picture_rate().flight_began(0);
  client.command({{"type", "play"}});
  client.wait_since(before, lowered);
  // The short run has been played to its end, or soon will be: changes are reported all the same.
  const std::size_t between = client.texts().size();
  server.runs().picture_rate().flight_ended();
  client.wait_since(between, wanted);
}

}  // namespace
}  // namespace overfly::testing
