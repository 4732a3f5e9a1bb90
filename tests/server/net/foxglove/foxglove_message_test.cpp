// Messages of the Foxglove protocol, after its specification: what clients send, and the bytes that
// the server sends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "server/net/foxglove/client_message.hpp"
#include "server/net/foxglove/server_message.hpp"
#include "server/ros2/ros2_message.hpp"

namespace overfly::net::foxglove {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <typename T>
T text_command(const json& message) {
  const auto command = parse_text(message.dump());
  if (!command) throw std::runtime_error(command.error().message);
  return std::get<T>(*command);
}

std::string text_error(const std::string& message) {
  const auto command = parse_text(message);
  return command ? "none" : command.error().message;
}

/// A request of playback control as the protocol lays it out.
Bytes control_bytes(std::uint8_t command,
                    float speed,
                    std::uint8_t seeks,
                    std::uint64_t time_ns,
                    const std::string& id,
                    std::uint32_t id_bytes) {
  Bytes bytes(19);
  bytes[0] = 3;
  bytes[1] = command;
  std::memcpy(&bytes[2], &speed, 4);
  bytes[6] = seeks;
  std::memcpy(&bytes[7], &time_ns, 8);
  std::memcpy(&bytes[15], &id_bytes, 4);
  bytes.insert(bytes.end(), id.begin(), id.end());
  return bytes;
}

TEST(FoxgloveMessage, ReadsSubscriptions) {
  const auto command = text_command<Subscribe>(
      {{"op", "subscribe"},
       {"subscriptions", {{{"id", 0}, {"channelId", 3}}, {{"id", 4294967295U}, {"channelId", 1}}}},
       {"later", "fields are ignored"}});
  ASSERT_EQ(command.entries.size(), 2U);
  EXPECT_EQ(command.entries[0].channel, 3U);
  EXPECT_EQ(command.entries[1].subscription, 4294967295U);
  EXPECT_THAT(
      text_command<Unsubscribe>({{"op", "unsubscribe"}, {"subscriptionIds", {7, 9}}}).subscriptions,
      ElementsAre(7, 9));
}

TEST(FoxgloveMessage, ReadsParameters) {
  const auto get = text_command<GetParameters>(
      {{"op", "getParameters"}, {"parameterNames", {"a"}}, {"id", "7"}});
  EXPECT_THAT(get.names, ElementsAre("a"));
  EXPECT_EQ(get.id, "7");
  const auto set = text_command<SetParameters>(
      {{"op", "setParameters"}, {"parameters", {{{"name", "speed"}, {"value", 2.5}}}}});
  ASSERT_EQ(set.values.size(), 1U);
  EXPECT_EQ(set.values[0].first, "speed");
  EXPECT_EQ(set.values[0].second, 2.5);
  EXPECT_FALSE(set.id);
  EXPECT_FALSE(text_command<WatchParameters>(
                   {{"op", "unsubscribeParameterUpdates"}, {"parameterNames", json::array()}})
                   .wanted);
}

TEST(FoxgloveMessage, NamesWhatIsWrongInAText) {
  EXPECT_THAT(text_error("nothing"), HasSubstr("a message"));
  EXPECT_THAT(text_error("[]"), HasSubstr("a message"));
  EXPECT_THAT(text_error(R"({"op": 1})"), HasSubstr("op: must be text"));
  EXPECT_THAT(text_error(R"({"op": "subscribe"})"), HasSubstr("subscriptions: must be an array"));
  EXPECT_THAT(text_error(R"({"op": "subscribe", "subscriptions": [1]})"), HasSubstr("objects"));
  EXPECT_THAT(text_error(R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 1}]})"),
              HasSubstr("subscriptions.id: must be a whole number"));
  EXPECT_THAT(text_error(R"({"op": "unsubscribe", "subscriptionIds": [4294967296]})"),
              HasSubstr("[0, 2^32)"));
  EXPECT_THAT(text_error(R"({"op": "setParameters", "parameters": [{"name": 1}]})"),
              HasSubstr("parameters.name"));
  const json many = {{"op", "unsubscribe"}, {"subscriptionIds", std::vector<int>(1025, 1)}};
  EXPECT_THAT(text_error(many.dump()), HasSubstr("at most 1024"));
  EXPECT_EQ(std::get<NotOffered>(*parse_text(R"({"op": "fetchAsset", "uri": "x"})")).what,
            "fetchAsset");
}

TEST(FoxgloveMessage, ReadsPlaybackControl) {
  const auto command = parse_binary(control_bytes(0, 0.5F, 1, 1'700'000'000'123'456'789U, "id", 2));
  ASSERT_TRUE(command) << command.error().message;
  const auto& control = std::get<PlaybackControl>(*command);
  EXPECT_TRUE(control.play);
  EXPECT_EQ(control.speed, 0.5);
  EXPECT_EQ(control.seek_utc_ns, 1'700'000'000'123'456'789U);
  EXPECT_EQ(control.request_id, "id");
  EXPECT_FALSE(
      std::get<PlaybackControl>(*parse_binary(control_bytes(1, 1.0F, 0, 5, "", 0))).seek_utc_ns);
}

TEST(FoxgloveMessage, RefusesBinaryMessagesThatEndTooSoon) {
  EXPECT_FALSE(parse_binary({}));
  const Bytes whole = control_bytes(0, 1.0F, 0, 0, "abc", 3);
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_FALSE(parse_binary(std::span(whole).first(size))) << size;
  }
  EXPECT_TRUE(parse_binary(whole));
  EXPECT_FALSE(parse_binary(control_bytes(0, 1.0F, 0, 0, "abc", 4294967295U)));
  EXPECT_FALSE(parse_binary(control_bytes(2, 1.0F, 0, 0, "", 0)));
  EXPECT_FALSE(parse_binary(Bytes{9, 0}));
  EXPECT_TRUE(std::holds_alternative<NotOffered>(*parse_binary(Bytes{1, 0})));
}

TEST(FoxgloveMessage, WritesTheBytesOfTheProtocol) {
  EXPECT_EQ(data_head(0x01020304, 0x0102030405060708),
            (Bytes{1, 4, 3, 2, 1, 8, 7, 6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(time_message(5), (Bytes{2, 5, 0, 0, 0, 0, 0, 0, 0}));
  PlaybackState state;
  state.status = PlaybackStatus::kEnded;
  state.utc_ns = 258;
  state.speed = 1.0;
  state.did_seek = true;
  state.request_id = "ab";
  EXPECT_EQ(playback_message(state),
            (Bytes{5, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3f, 1, 2, 0, 0, 0, 'a', 'b'}));
}

TEST(FoxgloveMessage, WritesTheTextsOfTheProtocol) {
  ServerInfo info;
  info.name = "n";
  info.session = "s";
  EXPECT_EQ(json::parse(info_text(info)),
            json::parse(R"({"op": "serverInfo", "name": "n", "sessionId": "s", "metadata": {},
                            "capabilities": ["time", "parameters", "parametersSubscribe"]})"));
  info.span_utc_ns = {1'000'000'002, 3'000'000'000};
  const json replay = json::parse(info_text(info));
  EXPECT_EQ(replay.at("capabilities").back(), "playbackControl");
  EXPECT_EQ(replay.at("dataStartTime"), json({{"sec", 1}, {"nsec", 2}}));
  EXPECT_EQ(json::parse(status_text(StatusLevel::kError, "m", "i")),
            json({{"op", "status"}, {"level", 2}, {"message", "m"}, {"id", "i"}}));
  Channel channel{4, "/tf", ChannelKind::kTransforms, 0, &server::kRos2TfMessage};
  const json advertised = json::parse(advertise_text({channel})).at("channels").at(0);
  EXPECT_EQ(advertised.at("id"), 4);
  EXPECT_EQ(advertised.at("encoding"), "cdr");
  EXPECT_EQ(advertised.at("schemaEncoding"), "ros2msg");
  EXPECT_EQ(advertised.at("schemaName"), "tf2_msgs/msg/TFMessage");
  EXPECT_EQ(json::parse(unadvertise_text({channel})),
            json({{"op", "unadvertise"}, {"channelIds", {4}}}));
  EXPECT_EQ(json::parse(parameters_text({{"speed", 1, true}}, "q")),
            json::parse(R"({"op": "parameterValues", "id": "q",
                            "parameters": [{"name": "speed", "value": 1, "type": "float64"}]})"));
}

}  // namespace
}  // namespace overfly::net::foxglove
