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

TEST(ClientMessage, ReadsWatchWithPlaceAndResume) {
  const auto watch = parse_as<WatchCommand>(
      R"({"type":"watch","request":3,"run":"r1","offset_ns":-5,"resume":{"truth":17,"estimate/a":4}})");
  EXPECT_EQ(watch.run_id, "r1");
  EXPECT_EQ(watch.offset_ns, -5);
  EXPECT_EQ(watch.resume->at("truth"), 17U);
  EXPECT_EQ(watch.resume->at("estimate/a"), 4U);
  EXPECT_FALSE(parse_as<WatchCommand>(R"({"type":"watch","run":"r1"})").resume);
}

TEST(ClientMessage, ReadsSubscriptionsWithDefaults) {
  const auto subscribe = parse_as<SubscribeCommand>(
      R"({"type":"subscribe","pictures":[{"run":"r","name":"camera"},
          {"run":"q","name":"debug/a","max_hz":5,"quality":60},
          {"run":"r","name":"scene"},{"run":"r","name":"scene","view":"map"}]})");
  ASSERT_EQ(subscribe.pictures.size(), 4U);
  EXPECT_EQ(subscribe.pictures[0], (StreamRequest{"r", "camera", 31.0, 75, 1280}));
  EXPECT_EQ(subscribe.pictures[1], (StreamRequest{"q", "debug/a", 5.0, 60, 1280}));
  EXPECT_EQ(subscribe.pictures[3], (StreamRequest{"r", "scene", 31.0, 75, 1280, false, "", "map"}));
}

TEST(ClientMessage, ReadsWhatAClientCanShowAndHasShown) {
  const auto subscribe = parse_as<SubscribeCommand>(
      R"({"type":"subscribe","acknowledge":true,"pictures":[
          {"run":"r","name":"camera","encoding":"vp8"},{"run":"r","name":"scene","encoding":"jpeg"},
          {"run":"r","name":"depth"}]})");
  EXPECT_TRUE(subscribe.acknowledges);
  ASSERT_EQ(subscribe.pictures.size(), 3U);
  EXPECT_TRUE(subscribe.pictures[0].video);
  EXPECT_FALSE(subscribe.pictures[1].video);
  EXPECT_FALSE(subscribe.pictures[2].video);
  const auto shown =
      parse_as<ShownCommand>(R"({"type":"shown","pictures":[[3,17],[4294967295,0]]})");
  EXPECT_THAT(shown.pictures,
              ::testing::ElementsAre(std::pair(3U, 17U), std::pair(4294967295U, 0U)));
  EXPECT_EQ(parse_as<KeyCommand>(R"({"type":"key","id":9})").stream_id, 9U);
  for (const char* wrong : {
           R"({"type":"shown"})",
           R"({"type":"shown","pictures":[[3]]})",
           R"({"type":"shown","pictures":[[3,-1]]})",
           R"({"type":"shown","pictures":[[3,4294967296]]})",
           R"({"type":"shown","pictures":[3]})",
           R"({"type":"key"})",
           R"({"type":"key","id":-1})",
           R"({"type":"subscribe","pictures":[{"run":"r","name":"camera","encoding":"gif"}]})",
       }) {
    EXPECT_FALSE(parse_client_message(wrong).status.ok()) << wrong;
  }
}

TEST(ClientMessage, ReadsTheOtherRunsOfAScene) {
  const auto subscribe = parse_as<SubscribeCommand>(
      R"({"type":"subscribe","pictures":[{"run":"r","name":"scene","first_colour":2,
          "with":[{"run":"q","first_colour":5},{"run":"s"}]}]})");
  ASSERT_EQ(subscribe.pictures.size(), 1U);
  EXPECT_EQ(subscribe.pictures[0].look.first_colour, 2U);
  EXPECT_EQ(subscribe.pictures[0].with, (std::vector<SceneRun>{{"q", {5}}, {"s", {}}}));
}

TEST(ClientMessage, ReadsTheLookOfTracks) {
  const auto subscribe = parse_as<SubscribeCommand>(
      R"({"type":"subscribe","pictures":[{"run":"r","name":"scene","hide":["","a"],
          "colours":{"":"#000000","b":"#FF8000"},"with":[{"run":"q","hide":["c"]}]}]})");
  const server::TrackLook& look = subscribe.pictures.at(0).look;
  EXPECT_EQ(look.hidden, (std::set<std::string>{"", "a"}));
  EXPECT_EQ(look.truth_rgb(), (server::TrackRgb{0.0F, 0.0F, 0.0F}));
  EXPECT_EQ(look.rgb_of("b", 3), (server::TrackRgb{1.0F, 128.0F / 255.0F, 0.0F}));
  EXPECT_EQ(look.rgb_of("c", 1), server::estimator_rgb(1));
  EXPECT_FALSE(subscribe.pictures[0].with.at(0).look.shows("c"));
  for (const std::string& wrong : {R"("hide":"a")",
                                   R"("hide":[1])",
                                   R"("colours":{"a":"red"})",
                                   R"("colours":{"a":"#12345"})",
                                   R"("colours":{"a":"#12345g"})",
                                   R"("colours":{"a":"#+12345"})",
                                   R"("colours":{"a":123456})"}) {
    const std::string text =
        R"({"type":"subscribe","pictures":[{"run":"r","name":"scene",)" + wrong + "}]}";
    EXPECT_FALSE(parse_client_message(text).status.ok()) << wrong;
  }
  std::string many = R"({"type":"subscribe","pictures":[{"run":"r","name":"scene","hide":[)";
  for (int i = 0; i < 65; ++i) many += (i > 0 ? ",\"e" : "\"e") + std::to_string(i) + "\"";
  EXPECT_FALSE(parse_client_message(many + "]}]}").status.ok());
}

TEST(ClientMessage, ReadsTheContentsAndThePlaceOfAView) {
  const auto view = parse_as<ViewCommand>(
      R"({"type":"view","mode":"free","elevation_deg":-90,"x_m":1,"y_m":-2,"z_m":300,
          "show":["image","labels"]})");
  EXPECT_EQ(view.mode, server::SceneMode::kFree);
  EXPECT_EQ(view.eye_world_m, Eigen::Vector3d(1, -2, 300));
  ASSERT_TRUE(view.show);
  server::SceneShow expected{false, false, false, false, false, true, false, false, true};
  EXPECT_EQ(*view.show, expected);
  EXPECT_FALSE(parse_as<ViewCommand>(R"({"type":"view","mode":"onboard"})").show);
  for (const char* wrong : {R"("show":["trees"])",
                            R"("show":[7])",
                            R"("show":"image")",
                            R"("x_m":1,"y_m":2)",
                            R"("x_m":1e7,"y_m":2,"z_m":3)",
                            R"("mode":"underwater")",
                            R"("elevation_deg":-91)"}) {
    EXPECT_FALSE(parse_client_message(R"({"type":"view",)" + std::string(wrong) + "}").status.ok())
        << wrong;
  }
}

TEST(ClientMessage, ReadsDepthAndErrorStreams) {
  const auto subscribe = parse_as<SubscribeCommand>(
      R"({"type":"subscribe","pictures":[{"run":"r","name":"depth","camera":"left"},
          {"run":"r","name":"error","camera":"left"},{"run":"r","name":"error/feature"}]})");
  ASSERT_EQ(subscribe.pictures.size(), 3U);
  EXPECT_EQ(subscribe.pictures[0].camera, "left");
  EXPECT_EQ(subscribe.pictures[2].name, "error/feature");
  for (const char* wrong : {R"("name":"error/")",
                            R"("name":"deep")",
                            R"("name":"error/feature","camera":"left")",
                            R"("name":"debug/feature","camera":"left")"}) {
    const ClientMessage message = parse_client_message(
        R"({"type":"subscribe","pictures":[{"run":"r",)" + std::string(wrong) + "}]}");
    EXPECT_FALSE(message.status.ok()) << wrong;
  }
}

TEST(ClientMessage, RefusesWrongOtherRuns) {
  const auto error_of = [](const std::string& stream) {
    const std::string text = R"({"type":"subscribe","pictures":[{"run":"r",)" + stream + "}]}";
    const ClientMessage message = parse_client_message(text);
    return message.status ? std::string("no error") : message.status.error().message;
  };
  EXPECT_THAT(error_of(R"("name":"camera","with":[{"run":"q"}])"), HasSubstr("only to the stream"));
  EXPECT_THAT(error_of(R"("name":"camera","first_colour":1)"), HasSubstr("only to the stream"));
  EXPECT_THAT(error_of(R"("name":"camera","compared":"sim3")"), HasSubstr("only to the stream"));
  EXPECT_THAT(error_of(R"("name":"scene","compared":3)"), HasSubstr("compared"));
  EXPECT_THAT(error_of(R"("name":"depth","hide":["a"])"), HasSubstr("only to the stream"));
  EXPECT_THAT(error_of(R"("name":"scene","first_colour":-1)"), HasSubstr("first_colour"));
  EXPECT_THAT(error_of(R"("name":"scene","with":[7])"), HasSubstr("with.0"));
  EXPECT_THAT(error_of(R"("name":"scene","with":[{"first_colour":1}])"), HasSubstr("run"));
  EXPECT_THAT(error_of(R"("name":"scene","with":[{"run":"q","x":1}])"), HasSubstr("x"));
  std::string many;
  for (int i = 0; i < 17; ++i) many += std::string(i == 0 ? "" : ",") + R"({"run":"q"})";
  EXPECT_THAT(error_of(R"("name":"scene","with":[)" + many + "]"), HasSubstr("at most 16"));
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
  EXPECT_EQ(parse_as<UnwatchCommand>(R"({"type":"unwatch","run":"r"})").run_id, "r");
  parse_as<PlayCommand>(R"({"type":"play"})");
  parse_as<PauseCommand>(R"({"type":"pause"})");
  parse_as<LiveCommand>(R"({"type":"live"})");
  const auto align = parse_as<AlignCommand>(R"({"type":"align","run":"r","mode":"sim3"})");
  EXPECT_EQ(align.run_id + " " + align.mode, "r sim3");
  EXPECT_EQ(parse_as<SpeedCommand>(R"({"type":"speed","value":-0.1})").value, -0.1);
  const auto range = parse_as<RangeCommand>(R"({"type":"range","begin_ns":-1,"end_ns":7})");
  EXPECT_EQ(range.range, (PlaybackClock::Range{-1, 7}));
  EXPECT_FALSE(parse_as<RangeCommand>(R"({"type":"range"})").range);
  EXPECT_EQ(parse_as<SeekCommand>(R"({"type":"seek","run":"r","frame":1})").run_id, "r");
  EXPECT_EQ(parse_as<StepCommand>(R"({"type":"step","run":"r","frames":1})").run_id, "r");
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
      {R"({"type":"watch","run":)" + std::string(65, '['), "is nested more than 64 deep"},
      {"[]", "must be a JSON object"},
      {"{}", "type"},
      {R"({"type":7})", "type"},
      {R"({"type":"fly"})", "type = \"fly\""},
      {R"({"type":"speed"})", "speed.value: is required"},
      {R"({"type":"speed","value":99})", "speed.value = 99: must be in [-50.0, 50.0]"},
      {R"({"type":"speed","value":0})", "speed.value = 0.0: must be at least 0.1, or at most -0.1"},
      {R"({"type":"speed","value":"1"})", "speed.value"},
      {R"({"type":"range","end_ns":1})", "a range needs begin_ns"},
      {R"({"type":"range","begin_ns":1,"end_ns":1})", "an end_ns after it"},
      {R"({"type":"seek","run":"a","t_ns":1})", "seek.run: applies only to a frame"},
      {R"({"type":"align","mode":"sim3"})", "align.run: is required"},
      {R"({"type":"watch","run":"a","offset_ns":86400000000001})", "watch.offset_ns"},
      {R"({"type":"play","now":1})", "play.now: is not a known field"},
      {R"({"type":"watch"})", "watch.run: is required"},
      {R"({"type":"watch","run":"a","resume":{"truth":-1}})", "watch.resume.truth = -1"},
      {R"({"type":"watch","run":"a","resume":7})", "watch.resume = 7"},
      {R"({"type":"subscribe"})", "subscribe.pictures: is required"},
      {R"({"type":"subscribe","pictures":[{"run":"r","name":"x"}]})", "pictures.0.name"},
      {R"({"type":"subscribe","pictures":[{"name":"camera"}]})", "pictures.0.run: is required"},
      {R"({"type":"subscribe","pictures":[{"run":"r","name":"debug/"}]})", "pictures.0.name"},
      {R"({"type":"subscribe","pictures":[7]})", "pictures.0"},
      {R"({"type":"subscribe","pictures":[{"run":"r","name":"camera"},{"run":"r","name":"camera"}]})",
       "camera of run r occurs twice"},
      {R"({"type":"subscribe","pictures":[{"run":"r","name":"camera","view":"map"}]})",
       "pictures.0.view: applies only"},
      {R"({"type":"subscribe","pictures":[{"run":"r","name":"camera","max_hz":0}]})",
       "pictures.0.max_hz"},
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
      R"({"type":"subscribe","request":1,"pictures":[{"run":"r","name":"scene","max_hz":15,"quality":75}]})";
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
