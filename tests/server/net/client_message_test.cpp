#include "server/net/stream/client_message.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/motion/pose.hpp"
#include "server/views/picture_request.hpp"

namespace overfly::net {
namespace {

using ::testing::HasSubstr;

template <typename Command>
Command parse_as(const std::string& text) {
  const ClientMessage message = parse_client_message(text);
  EXPECT_TRUE(message.status) << message.status.error().message;
  const auto* command = std::get_if<Command>(&message.command);
  EXPECT_NE(command, nullptr) << text;
  return command != nullptr ? *command : Command{};
}

TEST(ClientMessage, ReadsAttachWithResume) {
  const auto attach = parse_as<AttachCommand>(
      R"({"type":"attach","request":3,"run":"r1","resume":{"truth":17,"estimate/a":4}})");
  EXPECT_EQ(attach.run_id, "r1");
  EXPECT_EQ(attach.resume.at("truth"), 17U);
  EXPECT_EQ(attach.resume.at("estimate/a"), 4U);
}

TEST(ClientMessage, ReadsSubscriptionsWithDefaults) {
  const auto subscribe = parse_as<SubscribeCommand>(
      R"({"type":"subscribe","streams":[{"name":"camera"},{"name":"debug/a","max_hz":5,"quality":60}]})");
  ASSERT_EQ(subscribe.streams.size(), 2U);
  EXPECT_EQ(subscribe.streams[0], (StreamRequest{"camera", 31.0, 75, 1280}));
  EXPECT_EQ(subscribe.streams[1], (StreamRequest{"debug/a", 5.0, 60, 1280}));
}

TEST(ClientMessage, TurnsDegreesOfAViewIntoRadians) {
  const auto view =
      parse_as<ViewCommand>(R"({"type":"view","mode":"orbit","azimuth_deg":180,"width_px":960})");
  EXPECT_EQ(view.mode, server::SceneMode::kOrbit);
  EXPECT_NEAR(*view.azimuth_rad, kPi, 1e-12);
  EXPECT_EQ(view.width_px, 960);
  EXPECT_FALSE(view.distance_m);
}

TEST(ClientMessage, ReadsEachPlaybackCommand) {
  parse_as<DetachCommand>(R"({"type":"detach"})");
  parse_as<PlayCommand>(R"({"type":"play"})");
  parse_as<PauseCommand>(R"({"type":"pause"})");
  parse_as<LiveCommand>(R"({"type":"live"})");
  EXPECT_EQ(parse_as<AlignCommand>(R"({"type":"align","mode":"sim3"})").mode, "sim3");
  EXPECT_EQ(parse_as<SeekCommand>(R"({"type":"seek","t_ns":5000000000})").t_ns, 5'000'000'000);
  EXPECT_EQ(parse_as<SeekCommand>(R"({"type":"seek","frame":12})").frame, 12);
  EXPECT_EQ(parse_as<StepCommand>(R"({"type":"step","frames":-3})").frames, -3);
  EXPECT_EQ(parse_as<SpeedCommand>(R"({"type":"speed","value":2.5})").value, 2.5);
  EXPECT_TRUE(parse_as<LoopCommand>(R"({"type":"loop","value":true})").value);
}

TEST(ClientMessage, NamesTheFaultyField) {
  const std::pair<std::string, const char*> faults[] = {
      {"", "the message, line 1, column 1: syntax error"},
      {std::string(100'000, '['), "the message: is nested more than 64 deep"},
      {R"({"type":"attach","run":)" + std::string(65, '['), "is nested more than 64 deep"},
      {"[]", "must be a JSON object"},
      {"{}", "type"},
      {R"({"type":7})", "type"},
      {R"({"type":"fly"})", "type = \"fly\""},
      {R"({"type":"speed"})", "speed.value: is required"},
      {R"({"type":"speed","value":99})", "speed.value = 99: must be in [0.1, 50.0]"},
      {R"({"type":"speed","value":"1"})", "speed.value"},
      {R"({"type":"play","now":1})", "play.now: is not a known field"},
      {R"({"type":"attach"})", "attach.run: is required"},
      {R"({"type":"attach","run":"a","resume":{"truth":-1}})", "attach.resume.truth = -1"},
      {R"({"type":"attach","run":"a","resume":7})", "attach.resume = 7"},
      {R"({"type":"subscribe"})", "subscribe.streams: is required"},
      {R"({"type":"subscribe","streams":[{"name":"x"}]})", "streams.0.name"},
      {R"({"type":"subscribe","streams":[{"name":"debug/"}]})", "streams.0.name"},
      {R"({"type":"subscribe","streams":[7]})", "streams.0"},
      {R"({"type":"subscribe","streams":[{"name":"camera"},{"name":"camera"}]})", "occurs twice"},
      {R"({"type":"subscribe","streams":[{"name":"camera","max_hz":0}]})", "streams.0.max_hz"},
      {R"({"type":"view","mode":"side"})", "view.mode"},
      {R"({"type":"view","width_px":63})", "view.width_px = 63"},
      {R"({"type":"view","elevation_deg":91})", "view.elevation_deg"},
      {R"({"type":"seek"})", "either t_ns or frame"},
      {R"({"type":"seek","t_ns":1,"frame":1})", "either t_ns or frame"},
      {R"({"type":"seek","t_ns":1.5})", "seek.t_ns"},
      {R"({"type":"seek","t_ns":18446744073709551615})", "seek.t_ns"},
      {R"({"type":"seek","t_ns":1e300})", "seek.t_ns"},
      {R"({"type":"step","frames":null})", "step.frames"},
      {R"({"type":"loop","value":1})", "loop.value"}};
  for (const auto& [text, part] : faults) {
    const ClientMessage message = parse_client_message(text);
    ASSERT_FALSE(message.status) << text;
    EXPECT_EQ(message.status.error().code, ErrorCode::kInvalidArgument) << text;
    EXPECT_THAT(message.status.error().message, HasSubstr(part)) << text;
  }
}

TEST(ClientMessage, RepeatsTheRequestOfAFaultyMessage) {
  const ClientMessage message = parse_client_message(R"({"type":"speed","request":9,"value":0})");
  EXPECT_FALSE(message.status);
  EXPECT_EQ(message.request, 9);
}

TEST(ClientMessage, SurvivesEveryMutationOfAMessage) {
  const std::string seed =
      R"({"type":"subscribe","request":1,"streams":[{"name":"scene","max_hz":15,"quality":75}]})";
  std::mt19937 random(7);
  int understood = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = seed;
    for (int k = 0; k < 1 + i % 4; ++k) {
      text[random() % text.size()] = static_cast<char>(random() % 256);
    }
    if (i % 5 == 0) text.resize(random() % text.size());
    if (parse_client_message(text).status) ++understood;
  }
  EXPECT_GT(understood, 0);
  EXPECT_LT(understood, 20000);
}

TEST(ClientMessage, RefusesDeepNestingWithoutOverflowingTheStack) {
  const std::string deep = R"({"type":"play","x":)" + std::string(60000, '[');
  EXPECT_FALSE(parse_client_message(deep).status);
  const std::string closed = std::string(30000, '[') + std::string(30000, ']');
  EXPECT_FALSE(parse_client_message(R"({"type":"play","x":)" + closed + "}").status);
}

}  // namespace
}  // namespace overfly::net
