// The WebSocket connection: requests and their answers, order, errors, limits, end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <thread>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string upgrade_with(const std::string& headers) {
  return "GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\n"
         "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
         headers + "\r\n";
}

TEST(WebSocket, GreetsAndAnswersEachRequest) {
  const TestServer server;
  WebSocketClient client(server.port());
  EXPECT_TRUE(client.is_open());
  const json hello = client.wait_for("hello");
  EXPECT_EQ(hello.at("protocol"), 2);
  EXPECT_THAT(hello.at("server").get<std::string>(), HasSubstr("overfly "));
  EXPECT_EQ(client.command({{"type", "unwatch"}, {"run", "a"}}).at("code"), "conflict");
  const json error = client.command({{"type", "play"}});
  EXPECT_EQ(error.at("type"), "error");
  EXPECT_EQ(error.at("code"), "conflict");
  EXPECT_EQ(client.command({{"type", "watch"}, {"run", "none"}}).at("code"), "not_found");
  EXPECT_EQ(client.command({{"type", "watch"}, {"run", "../x"}}).at("code"), "not_found");
}

TEST(WebSocket, IsCountedAsAViewerOfTheRunThatItWatches) {
  TestServer server;
  const std::string id = server.start("slow");
  WebSocketClient client(server.port());
  client.command({{"type", "subscribe"}, {"pictures", {{{"run", id}, {"name", "camera"}}}}});
  client.command({{"type", "watch"}, {"run", id}});
  client.wait_for_picture([](const PictureMessage&) { return true; });
  client.command({{"type", "unwatch"}, {"run", id}});
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
    client.send({{"type", "watch"}, {"run", i % 3 == 2 ? "none" : id}, {"request", 2 * i}});
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

TEST(WebSocket, NotifiesItsViewersWhenTheServerShutsDown) {
  auto server = std::make_unique<TestServer>();
  const std::string id = server->fly("tiny");
  WebSocketClient watching(server->port());
  watching.command({{"type", "watch"}, {"run", id}});
  WebSocketClient idle(server->port());
  idle.wait_for("hello");
  std::thread stop([&] { server.reset(); });
  EXPECT_EQ(watching.read_to_end(), 1001);
  EXPECT_EQ(idle.read_to_end(), 1001);
  stop.join();
}

TEST(WebSocket, AnswersInvalidMessagesAndStaysOpen) {
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
  EXPECT_EQ(client.command({{"type", "subscribe"}, {"pictures", json::array()}}).at("type"), "ok");
}

TEST(WebSocket, EndsAConnectionWithAMessageThatIsTooLarge) {
  const TestServer server;
  WebSocketClient client(server.port());
  client.wait_for("hello");
  client.send_text(std::string(70'000, ' '));
  EXPECT_EQ(client.read_to_end(), 1009);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/health").status, 200);
}

TEST(WebSocket, SurvivesInvalidFrames) {
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
