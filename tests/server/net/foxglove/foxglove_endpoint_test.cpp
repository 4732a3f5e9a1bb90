// The endpoint of the Foxglove protocol on a server: who may connect, and a flight over it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kEndpointToken = "0123456789abcdefABCDEF-_";
constexpr const char* kEndpointPath = "/api/v1/foxglove";
const Headers kWebSocket = {{"Sec-WebSocket-Protocol", "foxglove.websocket.v1"}};

std::string endpoint_upgrade(const std::string& target, const std::string& more_headers) {
  return "GET " + target +
         " HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
         more_headers + "\r\n";
}

const std::string kOffer = "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n";

WebSocketClient::Options to_run(const std::string& run_id, const Headers& headers = kWebSocket) {
  WebSocketClient::Options options;
  options.headers = headers;
  options.target = std::string(kEndpointPath) + (run_id.empty() ? "" : "?run=" + run_id);
  return options;
}

json text_with_op(WebSocketClient* client, const std::string& op) {
  return client->wait_since(0, [&](const json& message) { return message.at("op") == op; });
}

json subscribe_all(const json& channels) {
  json list = json::array();
  for (const json& channel : channels) {
    list.push_back({{"id", channel.at("id")}, {"channelId", channel.at("id")}});
  }
  return {{"op", "subscribe"}, {"subscriptions", std::move(list)}};
}

TEST(FoxgloveEndpoint, ChoosesTheSubprotocol) {
  TestServer server;
  const auto chosen = [&](const std::string& offered) {
    WebSocketClient client(server.port(), to_run("", {{"Sec-WebSocket-Protocol", offered}}));
    return client.is_open() ? client.protocol() : "refused";
  };
  EXPECT_EQ(chosen("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(chosen("foxglove.sdk.v1"), "foxglove.sdk.v1");
  // In the client's order of preference.
  EXPECT_EQ(chosen("foxglove.websocket.v1, foxglove.sdk.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(chosen("other, foxglove.sdk.v1, foxglove.websocket.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(chosen("other"), "refused");
  EXPECT_THAT(exchange_raw(server.port(), endpoint_upgrade(kEndpointPath, "")),
              AllOf(StartsWith("HTTP/1.1 400"), HasSubstr("foxglove.sdk.v1")));
  const Answer plain = ask(server.port(), "GET", kEndpointPath);
  EXPECT_EQ(plain.status, 426);
  EXPECT_EQ(plain.json().at("error").at("code"), "upgrade_required");
}

TEST(FoxgloveEndpoint, AsksForTheToken) {
  TestServer server({}, kEndpointToken);
  const std::string shown = std::string(kEndpointPath) + "?token=" + kEndpointToken;
  EXPECT_THAT(exchange_raw(server.port(), endpoint_upgrade(kEndpointPath, kOffer)),
              StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(exchange_raw(server.port(),
                           endpoint_upgrade(std::string(kEndpointPath) + "?token=x", kOffer)),
              StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(exchange_raw(server.port(), endpoint_upgrade(shown, kOffer)),
              StartsWith("HTTP/1.1 101"));
}

/// A viewer on another site connects if its user gave it the address with the token; a page that
/// only knows where the server is does not.
TEST(FoxgloveEndpoint, LetsPagesOfOtherSitesConnectWithTheTokenOnly) {
  TestServer server({}, kEndpointToken);
  const std::string foreign = kOffer + "Origin: https://viewer.example\r\n";
  const std::string shown = std::string("?token=") + kEndpointToken;
  const std::string cookie = std::string("Cookie: overfly_80=") + kEndpointToken + "\r\n";
  EXPECT_THAT(exchange_raw(server.port(), endpoint_upgrade(kEndpointPath + shown, foreign)),
              StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(exchange_raw(server.port(), endpoint_upgrade(kEndpointPath, foreign + cookie)),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(exchange_raw(server.port(),
                           endpoint_upgrade(std::string(kEndpointPath) + "?token=x", foreign)),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(exchange_raw(server.port(), endpoint_upgrade("/api/v1/stream" + shown, foreign)),
              StartsWith("HTTP/1.1 403"));
  EXPECT_EQ(
      ask(server.port(), "GET", "/api/v1/runs" + shown, "", {{"Origin", "https://viewer.example"}})
          .status,
      403);
  TestServer open;
  EXPECT_THAT(exchange_raw(open.port(), endpoint_upgrade(kEndpointPath, foreign)),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(exchange_raw(open.port(), endpoint_upgrade(kEndpointPath + shown, foreign)),
              StartsWith("HTTP/1.1 403"));
}

TEST(FoxgloveEndpoint, CountsAsAViewer) {
  net::ServerLimits limits;
  limits.connections.max_viewers = 1;
  TestServer server(limits);
  WebSocketClient first(server.port(), to_run(""));
  ASSERT_TRUE(first.is_open());
  EXPECT_FALSE(WebSocketClient(server.port(), to_run("")).is_open());
  EXPECT_EQ(ask(server.port(), "GET", kEndpointPath).status, 503);
}

TEST(FoxgloveEndpoint, TellsThatThereIsNoRun) {
  TestServer server;
  WebSocketClient none(server.port(), to_run(""));
  EXPECT_THAT(text_with_op(&none, "status").at("message").get<std::string>(),
              HasSubstr("no run was flown yet"));
  WebSocketClient absent(server.port(), to_run("absent"));
  EXPECT_THAT(text_with_op(&absent, "status").at("message").get<std::string>(),
              HasSubstr("absent"));
}

TEST(FoxgloveEndpoint, SendsTheImagesOfALiveFlight) {
  TestServer server;
  const std::string earlier = server.fly("tiny");
  const std::string id = server.start("slow");
  // Without a name it is the one that flies.
  const auto timeline = server.runs().timeline(id);
  ASSERT_TRUE(timeline);
  while ((*timeline)->frame_count() < 3) {
    (void)(*timeline)->wait_for_change((*timeline)->revision(), 1000);
  }
  WebSocketClient client(server.port(), to_run(""));
  EXPECT_EQ(text_with_op(&client, "serverInfo").at("metadata").at("run"), id);
  const json channels = text_with_op(&client, "advertise").at("channels");
  client.send(subscribe_all(channels));
  std::uint32_t image_channel = 0;
  for (const json& channel : channels) {
    if (channel.at("topic") == "/camera/image_raw/compressed") image_channel = channel.at("id");
  }
  const auto images = [&] {
    std::size_t count = 0;
    for (const auto& message : client.binaries()) {
      std::uint32_t subscription = 0;
      std::memcpy(&subscription, message.data() + 1, sizeof subscription);
      if (message.at(0) == 1 && subscription == image_channel) ++count;
    }
    return count;
  };
  // Asking for the parameters reads on until their answer.
  for (int i = 0; images() < 3 && i < 600; ++i) {
    client.send({{"op", "getParameters"}, {"parameterNames", {"live"}}, {"id", std::to_string(i)}});
    const json answer = client.wait_since(0, [&](const json& message) {
      return message.at("op") == "parameterValues" && message.at("id") == std::to_string(i);
    });
    EXPECT_EQ(answer.at("parameters").at(0).at("value"), true);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_GE(images(), 3U);
  ASSERT_EQ(ask(server.port(), "POST", "/api/v1/runs/" + id + "/cancel").status, 202);
  server.wait_for_end(id);
  // The one that ended is the newest now; a name chooses another one.
  WebSocketClient again(server.port(), to_run(""));
  EXPECT_EQ(text_with_op(&again, "serverInfo").at("metadata").at("run"), id);
  WebSocketClient named(server.port(), to_run(earlier));
  EXPECT_EQ(text_with_op(&named, "serverInfo").at("metadata").at("run"), earlier);
}

TEST(FoxgloveEndpoint, ClosesAClientThatDoesNotRead) {
  net::ServerLimits limits;
  limits.max_unsent_bytes = 64 << 10;
  limits.send_buffer_bytes = 8 << 10;
  TestServer server(limits);
  const std::string id = server.fly("tiny");
  WebSocketClient::Options options = to_run(id);
  options.receive_buffer_bytes = 4 << 10;
  WebSocketClient slow(server.port(), options);
  const json channels = text_with_op(&slow, "advertise").at("channels");
  slow.send(subscribe_all(channels));
  // Each seek sends everything again.
  for (int i = 0; i < 400; ++i) {
    slow.send({{"op", "setParameters"},
               {"parameters", {{{"name", "t_s"}, {"value", i % 2 == 0 ? 1.5 : 0.5}}}}});
  }
  server.wait_for_log("a slow client was disconnected");
  EXPECT_EQ(slow.read_to_end(), 4000);
}

}  // namespace
}  // namespace overfly::testing
