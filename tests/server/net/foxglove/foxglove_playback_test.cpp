// The playback as clients of the Foxglove protocol steer it, and pictures and map points at its
// time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/evaluation.hpp"
#include "server/record/map_points.hpp"
#include "server/record/run_folder.hpp"
#include "server/ros2/ros2_flight.hpp"
#include "server/ros2/ros2_message.hpp"
#include "tests/server/net/foxglove/foxglove_flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using server::RunStatus;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

using Bytes = std::vector<std::uint8_t>;

template <typename T>
void append_number(Bytes* bytes, T value) {
  const std::size_t at = bytes->size();
  bytes->resize(at + sizeof(T));
  std::memcpy(bytes->data() + at, &value, sizeof(T));
}

/// A request of playback control. @param seek_ns  of the run; negative = none
Bytes control(bool play, float speed, std::int64_t seek_ns, const std::string& id) {
  Bytes bytes = {3, static_cast<std::uint8_t>(play ? 0 : 1)};
  append_number(&bytes, speed);
  append_number(&bytes, static_cast<std::uint8_t>(seek_ns >= 0 ? 1 : 0));
  append_number(&bytes, static_cast<std::uint64_t>(seek_ns >= 0 ? kFoxgloveEpochNs + seek_ns : 0));
  append_number(&bytes, static_cast<std::uint32_t>(id.size()));
  bytes.insert(bytes.end(), id.begin(), id.end());
  return bytes;
}

/// A state of the playback, as the protocol lays it out.
struct State {
  int status;
  double t_s;
  float speed;
  bool did_seek;
  std::string id;
  bool operator==(const State&) const = default;
};
void PrintTo(const State& state, std::ostream* out) {
  *out << state.status << " at " << state.t_s << " s x " << state.speed
       << (state.did_seek ? " after a seek" : "") << " for '" << state.id << "'";
}

State state_from(const Bytes& bytes) {
  const auto utc_ns =
      static_cast<std::int64_t>(FoxgloveClientFake::number<std::uint64_t>(bytes, 2));
  return {bytes.at(1),
          static_cast<double>(utc_ns - kFoxgloveEpochNs) / 1e9,
          FoxgloveClientFake::number<float>(bytes, 10),
          bytes.at(14) != 0,
          std::string(bytes.begin() + 19, bytes.end())};
}

std::vector<State> states_of(const FoxgloveClientFake& client) {
  std::vector<State> states;
  for (const Bytes& bytes : client.states()) states.push_back(state_from(bytes));
  return states;
}

TEST(FoxglovePlayback, IsControlledByClientsThatKnowIt) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 101), true);
  const json info = client.port.texts.at(0);
  EXPECT_EQ(info.at("capabilities").back(), "playbackControl");
  EXPECT_EQ(info.at("dataStartTime"), json({{"sec", 1'700'000'000}, {"nsec", 0}}));
  EXPECT_EQ(info.at("dataEndTime"), json({{"sec", 1'700'000'005}, {"nsec", 0}}));
  client.say(control(false, 1.0F, 2'000'000'000, "a"));
  client.subscribe("/camera/truth");
  client.wait(10);
  EXPECT_EQ(client.data("/camera/truth").back().t_ns, 2'000'000'000);
  client.say(control(true, 1e9F, -1, "b"));
  client.wait(2);
  EXPECT_THAT(states_of(client),
              ElementsAre(State{1, 0.0, 1.0F, false, ""},
                          State{1, 2.0, 1.0F, true, "a"},
                          State{0, 2.0, 50.0F, false, "b"},
                          State{3, 5.0, 50.0F, false, ""}));
  EXPECT_THAT(client.data("/camera/truth"), SizeIs(61));
  // Before the flight and after it; playing at the end begins again.
  client.say(control(false, 1.0F, 100'000'000'000, "c"));
  EXPECT_EQ(states_of(client).back(), (State{3, 5.0, 1.0F, true, "c"}));
  Bytes early = control(true, 1.0F, 0, "d");
  std::fill(early.begin() + 7, early.begin() + 15, std::uint8_t{0});
  client.say(early);
  EXPECT_EQ(states_of(client).back(), (State{0, 0.0, 1.0F, true, "d"}));
  EXPECT_EQ(client.data("/camera/truth").back().t_ns, 0);
  client.say(control(true, std::nanf(""), -1, "e"));
  EXPECT_THAT(client.texts("status").back().at("message").get<std::string>(), HasSubstr("speed"));
}

TEST(FoxglovePlayback, IsNotControlledWhileTheRunFliesNorByOlderClients) {
  FoxgloveClientFake live(foxglove_flight(RunStatus::kRunning, 10), true);
  FoxgloveClientFake older(foxglove_flight(RunStatus::kCompleted, 10), false);
  for (FoxgloveClientFake* client : {&live, &older}) {
    EXPECT_EQ(client->port.texts.at(0).at("capabilities").size(), 3U);
    client->say(control(true, 1.0F, 0, "a"));
    EXPECT_THAT(client->texts("status").back().at("message").get<std::string>(),
                HasSubstr("playback control"));
    client->wait(30);
    EXPECT_THAT(client->states(), IsEmpty());
  }
}

TEST(FoxglovePlayback, IsSteeredByParameters) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 41));
  client.subscribe("/camera/truth");
  client.set("speed", 2);
  client.set("loop", true);
  client.wait(21);  // 2.1 s: once to the end and a little further
  const auto truth = client.data("/camera/truth");
  EXPECT_LT(truth.back().t_ns, 200'000'000);
  EXPECT_GT(truth.size(), 41U);
  client.set("playing", false);
  client.set("t_s", 1.0);
  EXPECT_EQ(client.data("/camera/truth").back().t_ns, 1'000'000'000);
  EXPECT_EQ(client.parameter("playing"), false);
  EXPECT_EQ(client.parameter("loop"), true);
  EXPECT_EQ(client.parameter("speed"), 2.0);
  EXPECT_EQ(client.parameter("t_s"), 1.0);
  EXPECT_THAT(client.texts("status"), IsEmpty());
}

TEST(FoxglovePlayback, NamesTheParameterThatIsWrong) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 10));
  const auto answer = [&](const std::string& name, const json& value) {
    const std::size_t before = client.texts("status").size();
    client.set(name, value);
    const auto status = client.texts("status");
    return status.size() == before ? "" : status.back().at("message").get<std::string>();
  };
  EXPECT_EQ(answer("speed", 51), "speed: must be in [0.1, 50]");
  EXPECT_EQ(answer("speed", "fast"), "speed: must be in [0.1, 50]");
  EXPECT_EQ(answer("speed", -1), "speed: must be in [0.1, 50]");
  EXPECT_EQ(answer("t_s", nullptr), "t_s: must be in [0, 1e8] s");
  EXPECT_EQ(answer("playing", 1), "playing: must be true or false");
  EXPECT_EQ(answer("live", true), "live: the run does not fly");
  EXPECT_EQ(answer("run", "x"), "run: cannot be set; connect again");
  EXPECT_EQ(answer("other", 1), "parameter other: does not exist");
  EXPECT_THAT(answer("alignment", "best"), HasSubstr("alignment = best: must be one of"));
  EXPECT_THAT(answer("alignment", "sim3"), HasSubstr("not scored yet"));
  EXPECT_EQ(answer("t_s", 1e8), "");
  EXPECT_EQ(client.parameter("t_s"), 0.45);
}

TEST(FoxglovePlayback, TellsOfChangedParametersThatAreWatched) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 101));
  client.say(json{{"op", "subscribeParameterUpdates"}, {"parameterNames", {"t_s", "playing"}}});
  client.subscribe("/tf");
  client.wait(20);
  std::size_t changes = client.texts("parameterValues").size();
  EXPECT_GE(changes, 2U);
  EXPECT_LE(changes, 4U);
  for (const json& text : client.texts("parameterValues")) {
    EXPECT_FALSE(text.contains("id"));
    for (const json& entry : text.at("parameters")) EXPECT_NE(entry.at("name"), "speed");
  }
  client.say(json{{"op", "unsubscribeParameterUpdates"}, {"parameterNames", {"t_s", "playing"}}});
  client.wait(20);
  EXPECT_EQ(client.texts("parameterValues").size(), changes);
}

TEST(FoxglovePlayback, ShowsTheEstimatesByAnotherAlignment) {
  const auto flight = foxglove_flight(RunStatus::kCompleted, 10);
  server::RunMetrics metrics;
  server::EstimatorMetrics& scored = metrics.estimators["vo one"];
  scored.map_id = 0;
  scored.score.alignments[evaluation::AlignmentMode::kNone] = {};
  flight->set_metrics(metrics);
  FoxgloveClientFake client(flight);
  client.set("playing", false);
  client.set("t_s", 0.3);
  client.subscribe("/estimates/vo_one/pose_world");
  const Bytes recorded = client.data("/estimates/vo_one/pose_world").back().payload;
  client.set("alignment", "none");
  const Bytes as_estimated = client.data("/estimates/vo_one/pose_world").back().payload;
  EXPECT_NE(as_estimated, recorded);
  EXPECT_EQ(as_estimated, server::ros2_pose({kFoxgloveEpochNs + 300'000'000, "world"}, Pose{}));
  EXPECT_EQ(client.parameter("alignment"), "none");
}

server::Picture picture_of(std::int64_t frame, std::size_t bytes) {
  server::Picture picture;
  picture.frame = frame;
  picture.t_ns = frame * kFoxgloveFrameNs;
  picture.bytes = std::make_shared<const Bytes>(bytes, static_cast<std::uint8_t>(frame));
  return picture;
}

TEST(FoxglovePlayback, SendsOnlyTheNewestPicture) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 101));
  client.subscribe("/camera/image_raw/compressed");
  client.subscribe("/camera/camera_info");
  ASSERT_THAT(client.port.drawn, SizeIs(1));
  EXPECT_EQ(client.port.drawn[0].second.camera, "nadir");
  EXPECT_EQ(client.port.drawn[0].second.run_id, "run-1");
  client.wait(10);
  EXPECT_THAT(client.port.drawn, SizeIs(1)) << "one at a time";
  client.viewer().picture_ready(client.port.drawn[0].first, picture_of(0, 100), client.now_ns());
  EXPECT_THAT(client.port.drawn, SizeIs(1)) << "the first one is on its way";
  client.wait(10);
  client.viewer().picture_sent(client.port.sending.at(0), client.now_ns());
  ASSERT_THAT(client.port.drawn, SizeIs(2));
  EXPECT_EQ(client.port.drawn[1].second.t_ns, 1'000'000'000);
  client.viewer().picture_ready(client.port.drawn[1].first, picture_of(20, 50), client.now_ns());
  const auto images = client.data("/camera/image_raw/compressed");
  ASSERT_THAT(images, SizeIs(2));
  EXPECT_EQ(images[1].t_ns, 20 * kFoxgloveFrameNs);
  Bytes expected = server::ros2_jpeg_head(
      {kFoxgloveEpochNs + 20 * kFoxgloveFrameNs, "camera_optical_frame"}, 50);
  expected.insert(expected.end(), 50, std::uint8_t{20});
  EXPECT_EQ(images[1].payload, expected);
  // With the calibration of the same instant, which was also sent with the subscription.
  std::vector<std::int64_t> times_ns;
  for (const auto& info : client.data("/camera/camera_info")) times_ns.push_back(info.t_ns);
  EXPECT_EQ(times_ns, (std::vector<std::int64_t>{0, 0, 20 * kFoxgloveFrameNs}));
}

TEST(FoxglovePlayback, ReportsAPictureThatCannotBeDrawnOnce) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 101));
  client.subscribe("/estimates/vo_one/debug/compressed");
  const Error none{ErrorCode::kNotFound, "no picture"};
  const Error broken{ErrorCode::kIo, "broken"};
  for (const Error& error : {none, broken, broken}) {
    ASSERT_FALSE(client.port.drawn.empty());
    EXPECT_EQ(client.port.drawn.back().second.kind, server::PictureRequest::Kind::kDebug);
    client.viewer().picture_ready(client.port.drawn.back().first, error, client.now_ns());
    client.wait(2);
  }
  EXPECT_THAT(client.port.drawn, SizeIs(4));
  ASSERT_THAT(client.texts("status"), SizeIs(1));
  EXPECT_EQ(client.texts("status")[0].at("message"), "broken");
  EXPECT_EQ(client.texts("status")[0].at("id"), "/estimates/vo_one/debug/compressed");
}

TEST(FoxglovePlayback, SendsMapPointsOfTheTime) {
  const TemporaryFolder folder;
  server::MapPoints recorded;
  recorded.points_vo = {{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}};
  recorded.S_world_vo.scale = 2.0;
  const auto file = server::map_points_file(folder.path(), "vo one", 4);
  std::filesystem::create_directories(file.parent_path());
  const Bytes bytes = server::bytes_of(recorded);
  write_text(file, std::string(bytes.begin(), bytes.end()));
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 101), false, folder.path());
  client.set("playing", false);
  client.set("t_s", 0.3);
  client.subscribe("/estimates/vo_one/points");
  ASSERT_THAT(client.port.works, SizeIs(1));
  client.wait(30);
  EXPECT_THAT(client.port.works, SizeIs(1)) << "one at a time";
  client.port.works.front()()();
  const auto points = client.data("/estimates/vo_one/points");
  ASSERT_THAT(points, SizeIs(1));
  EXPECT_EQ(points[0].payload,
            server::ros2_points({kFoxgloveEpochNs + 300'000'000, "world"},
                                {{2.0F, 4.0F, 6.0F}, {8.0F, 10.0F, 12.0F}}));
  // What is read when the client has gone elsewhere meanwhile is not sent.
  client.set("t_s", 0.35);
  ASSERT_THAT(client.port.works, SizeIs(2));
  client.set("t_s", 4.0);
  client.port.works.back()()();
  EXPECT_THAT(client.data("/estimates/vo_one/points"), SizeIs(1));
}

TEST(FoxglovePlayback, SendsTheMapPointsOfALiveFlight) {
  const auto flight = foxglove_flight(RunStatus::kRunning, 10);
  FoxgloveClientFake client(flight);
  client.subscribe("/estimates/vo_one/points");
  flight->set_live_points(0, {{1.0F, 2.0F, 3.0F}});
  client.wait(20);
  const auto points = client.data("/estimates/vo_one/points");
  ASSERT_THAT(points, SizeIs(1)) << "again only if they have changed";
  EXPECT_EQ(points[0].payload,
            server::ros2_points({kFoxgloveEpochNs + 9 * kFoxgloveFrameNs, "world"},
                                {{1.0F, 2.0F, 3.0F}}));
}

}  // namespace
}  // namespace overfly::testing
