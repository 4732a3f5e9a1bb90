// The WebSocket protocol end to end: attach, rows, playback, pictures, resume.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <thread>

#include "server/files/jpeg.hpp"
#include "server/timing/picture_rate.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr std::int64_t kFrame = 1'000'000'000 / 31;

std::string upgrade_with(const std::string& headers) {
  return "GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\n"
         "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
         headers + "\r\n";
}

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

TEST(WebSocket, GreetsAndAnswersEachRequest) {
  const TestServer server;
  WebSocketClient client(server.port());
  EXPECT_TRUE(client.is_open());
  const json hello = client.wait_for("hello");
  EXPECT_EQ(hello.at("protocol"), 1);
  EXPECT_THAT(hello.at("server").get<std::string>(), HasSubstr("overfly "));
  EXPECT_EQ(client.command({{"type", "detach"}}).at("type"), "ok");
  const json error = client.command({{"type", "play"}});
  EXPECT_EQ(error.at("type"), "error");
  EXPECT_EQ(error.at("code"), "conflict");
  EXPECT_EQ(client.command({{"type", "attach"}, {"run", "none"}}).at("code"), "not_found");
  EXPECT_EQ(client.command({{"type", "attach"}, {"run", "../x"}}).at("code"), "not_found");
}

TEST(WebSocket, TellsAFinishedRunWholeAndWaitsAtItsStart) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  EXPECT_EQ(client.command({{"type", "attach"}, {"run", id}}).at("type"), "ok");
  const json playback = client.wait_until(is_playback);
  EXPECT_EQ(playback.at("t_ns"), 0);
  EXPECT_EQ(playback.at("frame"), 0);
  EXPECT_EQ(playback.at("playing"), false);
  EXPECT_EQ(playback.at("live"), false);
  EXPECT_TRUE(playback.at("truth").contains("roll_deg"));
  EXPECT_TRUE(playback.at("estimates").contains("perfect"));
  const auto rows = rows_of(client);
  EXPECT_EQ(rows.at("truth"), 63U);
  EXPECT_EQ(rows.at("estimate/perfect"), 63U);
  EXPECT_GE(rows.at("log"), 1U);
  std::set<std::string> types;
  for (const json& message : client.texts()) types.insert(message.at("type"));
  EXPECT_TRUE(types.contains("run"));
  EXPECT_TRUE(types.contains("streams"));
  EXPECT_TRUE(types.contains("metrics"));
  // Told before the metrics.
  json told;
  for (const json& message : client.texts()) {
    if (message.at("type") == "estimators") told = message;
  }
  ASSERT_TRUE(told.is_object());
  const json status = told.at("estimators").at("perfect");
  EXPECT_EQ(status.at("answered"), 63);
  EXPECT_EQ(status.at("dropped"), 0);
  EXPECT_TRUE(status.at("crash").is_null());
  EXPECT_GE(status.at("latency_ms").at("p99"), status.at("latency_ms").at("median"));
}

TEST(WebSocket, ResumesAfterTheRowsThatTheClientHas) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  client.command({{"type", "attach"}, {"run", id}, {"resume", {{"truth", 60}}}});
  client.wait_until(is_playback);
  for (const json& message : client.texts()) {
    if (message.at("type") == "rows" && message.at("stream") == "truth") {
      EXPECT_EQ(message.at("seq"), 60);
      EXPECT_EQ(message.at("columns").at("frame").front(), 60);
    }
  }
  EXPECT_EQ(rows_of(client).at("truth"), 63U);
}

TEST(WebSocket, SeeksStepsAndChangesSpeedWithoutTouchingOtherViewers) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  WebSocketClient other(server.port());
  for (WebSocketClient* each : {&client, &other}) {
    each->command({{"type", "attach"}, {"run", id}});
    each->wait_until(is_playback);
  }
  client.command({{"type", "seek"}, {"t_ns", kFrame + kFrame / 2}});
  json playback = client.wait_until(is_playback);
  EXPECT_EQ(playback.at("t_ns"), kFrame + kFrame / 2);
  EXPECT_EQ(playback.at("frame"), 1);
  const json rows =
      ask(server.port(), "GET", "/api/v1/runs/" + id + "/trajectories/truth?format=json").json();
  const double y_1 = rows.at("y_m").at(1);
  const double y_2 = rows.at("y_m").at(2);
  // Half way between two frames, up to the millimetres of the wire.
  EXPECT_NEAR(playback.at("truth").at("y_m"), 0.5 * (y_1 + y_2), 2e-3);
  client.command({{"type", "seek"}, {"frame", 40}});
  EXPECT_EQ(client.wait_until(is_playback).at("frame"), 40);
  client.command({{"type", "step"}, {"frames", -3}});
  EXPECT_EQ(client.wait_until(is_playback).at("frame"), 37);
  client.command({{"type", "step"}, {"frames", 1000}});
  EXPECT_EQ(client.wait_until(is_playback).at("frame"), 62);
  client.command({{"type", "speed"}, {"value", 50}});
  EXPECT_EQ(client.wait_until(is_playback).at("speed"), 50.0);
  client.command({{"type", "play"}});
  // From the start again, to the end in a 25th of a second.
  playback = client.wait_until(
      [](const json& message) { return is_playback(message) && !message.at("playing"); });
  EXPECT_EQ(playback.at("frame"), 62);
  other.command({{"type", "step"}, {"frames", 1}});
  EXPECT_EQ(other.wait_until(is_playback).at("frame"), 1);
}

TEST(WebSocket, SendsEveryStreamThePictureOfTheSoughtInstant) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  client.command({{"type", "subscribe"},
                  {"streams", {{{"name", "camera"}}, {{"name", "scene"}, {"max_hz", 15}}}}});
  client.command({{"type", "view"}, {"width_px", 96}, {"height_px", 64}, {"distance_m", 50}});
  client.command({{"type", "attach"}, {"run", id}});
  const json streams = client.wait_for("streams");
  std::map<std::uint32_t, std::string> names;
  for (const json& stream : streams.at("streams")) names[stream.at("id")] = stream.at("name");
  ASSERT_EQ(names.size(), 2U);
  for (const std::int64_t frame : {30, 10, 62, 0}) {
    client.command({{"type", "seek"}, {"frame", frame}});
    std::set<std::string> seen;
    while (seen.size() < 2) {
      const PictureMessage picture = client.wait_for_picture(
          [&](const PictureMessage& message) { return message.header.frame == frame; });
      seen.insert(names.at(picture.header.stream_id));
      const auto image = engine::decode_jpeg(picture.jpeg);
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

TEST(WebSocket, FollowsALiveRunAndLeavesItByASeek) {
  TestServer server;
  const std::string id = server.start("slow");
  WebSocketClient client(server.port());
  client.command({{"type", "subscribe"}, {"streams", {{{"name", "camera"}}}}});
  client.command({{"type", "attach"}, {"run", id}});
  const auto live_beyond = [](std::int64_t frame) {
    return [frame](const json& message) {
      return is_playback(message) && message.at("live") && message.at("frame") > frame;
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
    return message.header.frame == paused.at("frame") && !message.header.live;
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

TEST(WebSocket, ShowsEstimatesByTheAlignmentAskedFor) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  const json align = {{"type", "align"}, {"mode", "sim3"}};
  EXPECT_EQ(client.command(align).at("code"), "conflict");
  client.command({{"type", "attach"}, {"run", id}});
  EXPECT_EQ(client.wait_until(is_playback).at("alignment"), "init_scale");
  EXPECT_EQ(client.command({{"type", "align"}, {"mode", "sim4"}}).at("code"), "invalid_argument");
  // In its own frame, `none`, the estimate starts elsewhere than in the world.
  EXPECT_EQ(client.command({{"type", "align"}, {"mode", "none"}}).at("type"), "ok");
  client.command({{"type", "seek"}, {"frame", 40}});
  const auto at_40 = [](const json& message) {
    return is_playback(message) && message.at("frame") == 40;
  };
  json playback = client.wait_until(at_40);
  EXPECT_EQ(playback.at("alignment"), "none");
  const json columns =
      ask(server.port(),
          "GET",
          "/api/v1/runs/" + id + "/trajectories/perfect?format=json&alignment=none")
          .json();
  EXPECT_EQ(playback["estimates"]["perfect"]["pose"]["z_m"], columns["z_m"][40]);
  EXPECT_GT(std::abs(playback["truth"]["z_m"].get<double>() - columns["z_m"][40].get<double>()),
            10.0);
  client.command(align);
  playback = client.wait_until(at_40);
  EXPECT_EQ(playback.at("alignment"), "sim3");
  EXPECT_NEAR(playback["estimates"]["perfect"]["pose"]["z_m"], playback["truth"]["z_m"], 0.05);
  client.command({{"type", "attach"}, {"run", id}});
  EXPECT_EQ(client.wait_until(is_playback).at("alignment"), "init_scale");
}

TEST(WebSocket, NumbersAStreamByItsCamera) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  const auto number_of = [&](const json& stream) {
    EXPECT_EQ(
        client.command({{"type", "subscribe"}, {"streams", json::array({stream})}}).at("type"),
        "ok");
    const json told = client.wait_for("streams").at("streams").at(0);
    EXPECT_EQ(told.value("camera", ""), stream.value("camera", ""));
    return told.at("id").get<int>();
  };
  const int first = number_of({{"name", "camera"}});
  EXPECT_NE(number_of({{"name", "camera"}, {"camera", "tail"}}), first);
  EXPECT_EQ(number_of({{"name", "camera"}}), first);
  const json scene = {{"name", "scene"}, {"camera", "tail"}};
  EXPECT_EQ(client.command({{"type", "subscribe"}, {"streams", json::array({scene})}}).at("code"),
            "invalid_argument");
}

TEST(WebSocket, TellsHowOftenPicturesComeBesideAFlightInRealTime) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  const json streams = {{{"name", "camera"}, {"max_hz", 31}}, {{"name", "scene"}, {"max_hz", 2}}};
  client.command({{"type", "subscribe"}, {"streams", streams}});
  const auto limit_is = [](auto camera_hz) {
    return [camera_hz](const json& message) {
      return message.at("type") == "streams" && camera_hz(message["streams"][0]["limit_hz"]) &&
             message["streams"][0]["max_hz"] == 31.0 && message["streams"][1]["limit_hz"] == 2.0;
    };
  };
  const auto wanted = limit_is([](const json& hz) { return hz == 31.0; });
  // From the first rate on it follows how busy the machine is.
  const auto lowered = limit_is([](const json& hz) { return hz < 31.0; });
  client.wait_until(wanted);
  client.command({{"type", "attach"}, {"run", id}});
  server.runs().picture_rate().flight_began(0);
  client.command({{"type", "play"}});
  client.command({{"type", "subscribe"}, {"streams", streams}});
  client.wait_until(lowered);
  server.runs().picture_rate().flight_ended();
  // The short run may have been played to its end: from then on only commands are answered.
  client.command({{"type", "subscribe"}, {"streams", streams}});
  client.wait_until(wanted);
}

TEST(WebSocket, IsCountedAsAViewerOfTheRunItIsAttachedTo) {
  TestServer server;
  const std::string id = server.start("slow");
  WebSocketClient client(server.port());
  client.command({{"type", "subscribe"}, {"streams", {{{"name", "camera"}}}}});
  client.command({{"type", "attach"}, {"run", id}});
  client.wait_for_picture([](const PictureMessage&) { return true; });
  client.command({{"type", "detach"}});
  ASSERT_TRUE(server.runs().cancel(id).ok());
  server.wait_for_end(id);
  const json viewers =
      json::parse(read_text(server.folder() / "runs" / id / "timings.json")).at("viewers");
  EXPECT_EQ(viewers.at("viewers"), 1);
  EXPECT_EQ(viewers.at("most_at_once"), 1);
  EXPECT_GT(viewers.at("viewer_s").get<double>(), 0.0);
  EXPECT_GE(viewers.at("pictures").at("camera").get<int>(), 1);
  EXPECT_GT(viewers.at("cpu_s").get<double>(), 0.0);
}

TEST(WebSocket, CarriesOutCommandsInOrderWhileARunIsOpened) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient client(server.port());
  for (int i = 0; i < 300; ++i) {
    client.send({{"type", "attach"}, {"run", i % 3 == 2 ? "none" : id}, {"request", 2 * i}});
    client.send({{"type", "seek"}, {"frame", i % 60}, {"request", 2 * i + 1}});
  }
  for (int request = 0; request < 600; ++request) {
    const json answer = client.wait_until([](const json& message) {
      return message.at("type") == "ok" || message.at("type") == "error";
    });
    ASSERT_EQ(answer.at("request"), request);
    EXPECT_EQ(answer.at("type"), request % 6 == 4 ? "error" : "ok");
  }
}

TEST(WebSocket, TellsItsViewersWhenTheServerShutsDown) {
  auto server = std::make_unique<TestServer>();
  const std::string id = server->fly("tiny");
  WebSocketClient watching(server->port());
  watching.command({{"type", "attach"}, {"run", id}});
  WebSocketClient idle(server->port());
  idle.wait_for("hello");
  std::thread stop([&] { server.reset(); });
  EXPECT_EQ(watching.read_to_end(), 1001);
  EXPECT_EQ(idle.read_to_end(), 1001);
  stop.join();
}

TEST(WebSocket, AnswersWhatItDoesNotUnderstandAndStaysOpen) {
  const TestServer server;
  WebSocketClient client(server.port());
  client.send_text("{");
  EXPECT_THAT(client.wait_for("error").at("message").get<std::string>(),
              HasSubstr("the message, line 1, column 2: syntax error"));
  client.send_binary(std::string(100, '\xFF'));
  client.wait_for("error");
  std::mt19937 random(5);
  for (int i = 0; i < 200; ++i) {
    std::string text = R"({"type":"seek","t_ns":17,"request":4})";
    for (int k = 0; k < 3; ++k)
      text[random() % text.size()] = static_cast<char>(32 + random() % 95);
    client.send_text(text);
  }
  EXPECT_EQ(client.command({{"type", "detach"}}).at("type"), "ok");
}

TEST(WebSocket, EndsAConnectionWithAMessageThatIsTooLarge) {
  const TestServer server;
  WebSocketClient client(server.port());
  client.wait_for("hello");
  client.send_text(std::string(70'000, ' '));
  EXPECT_EQ(client.read_to_end(), 1009);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/health").status, 200);
}

TEST(WebSocket, SurvivesFramesThatAreNone) {
  const TestServer server;
  const std::string upgrade = upgrade_with("");
  std::mt19937 random(11);
  for (int i = 0; i < 60; ++i) {
    std::string bytes(1 + random() % 200, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random() % 256);
    EXPECT_THAT(exchange_raw(server.port(), upgrade + bytes), HasSubstr("HTTP/1.1 101"));
  }
  // A frame that claims 2^62 bytes.
  const std::string huge("\x81\xFF\x40\0\0\0\0\0\0\0abcd", 14);
  (void)exchange_raw(server.port(), upgrade + huge);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/health").status, 200);
}

TEST(WebSocket, IsClosedToPagesOfOtherSites) {
  const TestServer server;
  const auto accepts = [&](const std::string& origin) {
    return WebSocketClient(server.port(), {{{"Origin", origin}}, 0}).is_open();
  };
  EXPECT_FALSE(accepts("http://evil.example"));
  EXPECT_FALSE(accepts("null"));
  EXPECT_TRUE(accepts("http://127.0.0.1:" + std::to_string(server.port())));
  EXPECT_TRUE(accepts("http://localhost:" + std::to_string(server.port())));
  EXPECT_FALSE(accepts("http://localhost:5173"));
  EXPECT_THAT(exchange_raw(server.port(), upgrade_with("Origin: http://evil.example\r\n")),
              HasSubstr("HTTP/1.1 403"));
}

}  // namespace
}  // namespace overfly::testing
