// A client of the Foxglove protocol watches a flight: what it is told, and when.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "server/ros2/flight_names.hpp"
#include "server/ros2/ros2_flight.hpp"
#include "server/ros2/ros2_message.hpp"
#include "tests/server/net/foxglove/foxglove_flight.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using server::RunStatus;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

server::Ros2Header header_at(std::int64_t frame, const std::string& frame_id) {
  return {kFoxgloveEpochNs + frame * kFoxgloveFrameNs, frame_id};
}

Pose camera_at(std::int64_t frame) {
  return foxglove_place(frame) * Pose{R_body_camera_nadir(), {0.0, 0.0, 0.5}};
}

std::vector<std::int64_t> frames_of(const std::vector<FoxgloveData>& data) {
  std::vector<std::int64_t> frames;
  for (const FoxgloveData& message : data) frames.push_back(message.t_ns / kFoxgloveFrameNs);
  return frames;
}

std::vector<std::int64_t> numbers(std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> list;
  for (std::int64_t i = first; i <= last; ++i) list.push_back(i);
  return list;
}

TEST(FoxgloveViewer, AdvertisesTheTopicsOfTheRun) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 10));
  const json info = client.port.texts.at(0);
  EXPECT_EQ(info.at("op"), "serverInfo");
  EXPECT_THAT(info.at("name").get<std::string>(), HasSubstr("run run-1"));
  EXPECT_EQ(info.at("metadata"), json({{"run", "run-1"}, {"scenario", "valley"}}));
  std::vector<std::string> topics;
  const json advertised = client.texts("advertise").at(0);
  for (const json& channel : advertised.at("channels")) {
    topics.push_back(channel.at("topic"));
  }
  EXPECT_THAT(topics,
              ElementsAre("/tf",
                          "/rosout",
                          "/truth/path",
                          "/truth/fix",
                          "/camera/truth",
                          "/camera/camera_info",
                          "/camera/image_raw/compressed",
                          "/estimates/vo_one/pose",
                          "/estimates/vo_one/pose_world",
                          "/estimates/vo_one/path",
                          "/estimates/vo_one/fix",
                          "/estimates/vo_one/state",
                          "/estimates/vo_one/points",
                          "/estimates/vo_one/debug/compressed"));
}

TEST(FoxgloveViewer, PlaysAFinishedRunFromItsBeginning) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 30));
  client.wait(100);  // it waits for a subscription
  EXPECT_THAT(client.times_ns(), ElementsAre(0));
  client.subscribe("/camera/truth");
  client.subscribe("/estimates/vo_one/pose_world");
  client.wait(100);
  const auto truth = client.data("/camera/truth");
  EXPECT_EQ(frames_of(truth), numbers(0, 29));
  EXPECT_EQ(truth.at(7).payload, server::ros2_pose(header_at(7, "world"), camera_at(7)));
  const auto estimates = client.data("/estimates/vo_one/pose_world");
  EXPECT_EQ(frames_of(estimates), numbers(2, 29));
  Pose T_world_camera = camera_at(7);
  T_world_camera.translation.y() += 3.0;
  EXPECT_EQ(estimates.at(5).payload, server::ros2_pose(header_at(7, "world"), T_world_camera));
  const auto times = client.times_ns();
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  EXPECT_EQ(times.back(), 29 * kFoxgloveFrameNs);
  client.say(json{{"op", "getParameters"}, {"parameterNames", json::array()}});
  EXPECT_EQ(client.parameter("playing"), false);
  EXPECT_EQ(client.parameter("t_s"), 1.45);
}

TEST(FoxgloveViewer, SendsTransformsOfCamerasBodyAndEstimates) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 4));
  client.subscribe("/tf");
  client.wait(10);
  const auto tf = client.data("/tf");
  ASSERT_THAT(tf, SizeIs(4 * 2 + 2));
  EXPECT_EQ(tf.at(0).payload,
            server::ros2_transform(header_at(0, "world"), "camera_optical_frame", camera_at(0)));
  const Pose T_world_base{foxglove_place(0).rotation * server::R_body_base(),
                          foxglove_place(0).translation};
  EXPECT_EQ(tf.at(1).payload,
            server::ros2_transform(header_at(0, "world"), "base_link", T_world_base));
  Pose T_world_camera = camera_at(3);
  T_world_camera.translation.y() += 3.0;
  EXPECT_EQ(tf.back().payload,
            server::ros2_transform(header_at(3, "world"), "vo_one_camera", T_world_camera));
}

TEST(FoxgloveViewer, SendsStatesPlacesAndTheLog) {
  const auto flight = foxglove_flight(RunStatus::kCompleted, 4);
  flight->append_log({kFoxgloveFrameNs, "warning", "dropped", "", "vo one"});
  flight->append_log({kFoxgloveFrameNs * 9, "info", "completed", "", ""});  // after the last frame
  FoxgloveClientFake client(flight);
  client.subscribe("/rosout");
  client.subscribe("/truth/fix");
  client.subscribe("/estimates/vo_one/state");
  client.wait(10);
  const auto log = client.data("/rosout");
  ASSERT_THAT(log, SizeIs(2));
  EXPECT_EQ(log.at(0).payload,
            server::ros2_log({header_at(1, "").stamp_ns, "warning", "vo one", "dropped"}));
  EXPECT_EQ(log.at(1).payload,
            server::ros2_log({header_at(9, "").stamp_ns, "info", "overfly", "completed"}));
  const auto fixes = client.data("/truth/fix");
  ASSERT_THAT(fixes, SizeIs(4));
  const LocalFrame world(geodetic_from_deg(47.0, 8.0, 500.0));
  EXPECT_EQ(fixes.at(3).payload,
            server::ros2_fix(header_at(3, "base_link"),
                             world.geodetic_from_world(foxglove_place(3).translation)));
  const auto states = client.data("/estimates/vo_one/state");
  ASSERT_THAT(states, SizeIs(4));
  const auto text_of = [](const FoxgloveData& data) {
    return std::string(data.payload.begin(), data.payload.end());
  };
  EXPECT_THAT(text_of(states.at(0)), HasSubstr("INITIALISING"));
  EXPECT_THAT(text_of(states.at(3)), HasSubstr("TRACKING"));
  // The estimate flies 3 m beside the truth.
  const std::vector<std::uint8_t>& payload = states.at(3).payload;
  const std::size_t error_at = payload.size() - 5 * sizeof(double);
  EXPECT_NEAR(FoxgloveClientFake::number<double>(payload, error_at), 3.0, 1e-9);
}

TEST(FoxgloveViewer, FollowsAFlightLive) {
  const auto flight = foxglove_flight(RunStatus::kRunning, 5);
  FoxgloveClientFake client(flight);
  client.subscribe("/camera/truth");
  client.subscribe("/estimates/vo_one/pose_world");
  EXPECT_EQ(frames_of(client.data("/camera/truth")), numbers(4, 4));  // what is shown now
  append_foxglove_frame(5, flight.get());
  append_foxglove_frame(6, flight.get());
  client.wait(1);
  append_foxglove_answer(5, flight.get());  // late
  client.wait(1);
  EXPECT_EQ(frames_of(client.data("/camera/truth")), numbers(4, 6));
  EXPECT_EQ(frames_of(client.data("/estimates/vo_one/pose_world")), numbers(4, 5));
  server::RunInfo info = flight->info();
  info.status = RunStatus::kCompleted;
  append_foxglove_frame(7, flight.get());
  flight->set_info(info);
  client.wait(2);
  EXPECT_EQ(frames_of(client.data("/camera/truth")), numbers(4, 7));
  EXPECT_EQ(client.times_ns().back(), 7 * kFoxgloveFrameNs);
}

TEST(FoxgloveViewer, AFlightThatGoesBackToLiveShowsTheNewest) {
  const auto flight = foxglove_flight(RunStatus::kRunning, 40);
  FoxgloveClientFake client(flight);
  client.subscribe("/camera/truth");
  client.set("t_s", 0.5);
  client.set("playing", false);
  EXPECT_EQ(frames_of(client.data("/camera/truth")).back(), 10);
  append_foxglove_frame(40, flight.get());
  client.wait(3);
  EXPECT_EQ(frames_of(client.data("/camera/truth")).back(), 10);
  client.set("live", true);
  EXPECT_EQ(client.parameter("live"), true);
  EXPECT_EQ(frames_of(client.data("/camera/truth")).back(), 40);
}

TEST(FoxgloveViewer, KeepsEveryRowForASlowClient) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 3000));
  client.subscribe("/camera/truth");
  client.subscribe("/tf");
  client.set("speed", 50);
  client.port.keeps_unsent = true;
  for (int i = 0; i < 400; ++i) client.wait(1);
  const std::size_t held = client.port.unsent;
  EXPECT_LT(held, net::kHighWaterBytes + 10'000);
  EXPECT_LT(client.data("/camera/truth").size(), 3000U);
  for (int i = 0; i < 400; ++i) {
    client.port.unsent = 0;
    client.wait(1);
  }
  EXPECT_EQ(frames_of(client.data("/camera/truth")), numbers(0, 2999));
}

TEST(FoxgloveViewer, SendsTracksAtMostOnceASecond) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 101));
  client.subscribe("/truth/path");
  client.wait(100);
  const auto paths = client.data("/truth/path");
  ASSERT_GE(paths.size(), 5U);
  EXPECT_LE(paths.size(), 8U);
  const auto last = frames_of(paths).back();
  std::vector<server::StampedPose> poses;
  for (std::int64_t i = 0; i <= last; ++i) {
    Pose T_world_base = foxglove_place(i);
    T_world_base.rotation = T_world_base.rotation * server::R_body_base();
    poses.push_back({header_at(i, "").stamp_ns, T_world_base});
  }
  EXPECT_EQ(paths.back().payload, server::ros2_path(header_at(last, "world"), poses));
}

TEST(FoxgloveViewer, ThinsOutLongTracks) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 2501));
  client.set("t_s", 125.0);
  client.subscribe("/truth/path");
  const auto path = client.data("/truth/path").back();
  EXPECT_EQ(frames_of({path}).back(), 2500);
  const auto poses = FoxgloveClientFake::number<std::uint32_t>(path.payload, 4 + 8 + 4 + 8);
  EXPECT_EQ(poses, 834U);  // every third, and the last one
}

TEST(FoxgloveViewer, TellsOfARunThatCannotBeOpened) {
  FakePort port;
  net::foxglove::FoxgloveViewer viewer(port, {"", "s", true, nullptr});
  viewer.greet("c1");
  EXPECT_EQ(port.opened, "the newest");
  viewer.take_text(R"({"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 1}]})", 0);
  viewer.run_opened(Error{ErrorCode::kNotFound, "no run"}, 0);
  ASSERT_THAT(port.texts, SizeIs(3));
  EXPECT_EQ(port.texts[0].at("op"), "serverInfo");
  EXPECT_EQ(port.texts[1], json({{"op", "status"}, {"level", 2}, {"message", "no run"}}));
  EXPECT_THAT(port.texts[2].at("message").get<std::string>(), HasSubstr("channel 1"));
  EXPECT_FALSE(viewer.tick_after_ns());
}

TEST(FoxgloveViewer, TellsOfAFlightOutsideTheTimesOfTheMessages) {
  const auto flight = foxglove_flight(RunStatus::kCompleted, 3);
  server::RunInfo info = flight->info();
  info.epoch_utc_ns = 4'000'000'000'000'000'000;  // 2096
  flight->set_info(info);
  FoxgloveClientFake client(flight, true);
  client.subscribe("/tf");
  client.wait(5);
  ASSERT_THAT(client.texts("status"), SizeIs(1));
  EXPECT_THAT(client.texts("status").front().at("message").get<std::string>(), HasSubstr("2038"));
  EXPECT_THAT(client.port.binaries, IsEmpty());
}

TEST(FoxgloveViewer, AdvertisesAnewWhenTheCamerasBecomeKnown) {
  server::RunInfo info;
  info.id = "run-1";
  info.status = RunStatus::kQueued;
  const auto flight = std::make_shared<server::RunTimeline>(info, std::vector<std::string>{});
  FoxgloveClientFake client(flight);
  client.subscribe("/tf");
  client.wait(2);
  EXPECT_EQ(client.channel("/oblique/truth"), -1);
  EXPECT_THAT(client.port.binaries, IsEmpty());
  info.status = RunStatus::kRunning;
  info.epoch_utc_ns = kFoxgloveEpochNs;
  flight->set_info(info);
  flight->set_cameras({{"nadir", {}, {}}, {"oblique", {}, {}}});
  append_foxglove_frame(0, flight.get());
  const auto before = client.channel("/tf");
  client.wait(1);
  EXPECT_THAT(client.texts("unadvertise"), SizeIs(1));
  EXPECT_GT(client.channel("/tf"), before);
  ASSERT_NE(client.channel("/oblique/truth"), -1);
  client.subscribe("/tf");
  EXPECT_THAT(client.data("/tf"), SizeIs(2));
}

TEST(FoxgloveViewer, RefusesSubscriptionsThatAreNotPossible) {
  FoxgloveClientFake client(foxglove_flight(RunStatus::kCompleted, 3));
  client.subscribe("/tf");
  client.subscribe("/tf");
  client.say(json{{"op", "subscribe"}, {"subscriptions", {{{"id", 90}, {"channelId", 1}}}}});
  client.say(json{{"op", "subscribe"}, {"subscriptions", {{{"id", 91}, {"channelId", 999}}}}});
  client.say(json{{"op", "unsubscribe"}, {"subscriptionIds", {91}}});
  client.say(json{{"op", "advertise"}, {"channels", json::array()}});
  client.say(json("text"));
  std::vector<std::string> said;
  for (const json& status : client.texts("status")) said.push_back(status.at("message"));
  EXPECT_THAT(said,
              ElementsAre("subscription 1 is in use",
                          "/tf is subscribed to already",
                          "channel 999 does not exist",
                          "subscription 91 does not exist",
                          "advertise: this server does not offer it",
                          HasSubstr("a message")));
  client.say(json{{"op", "unsubscribe"}, {"subscriptionIds", {1}}});
  const std::size_t sent = client.data("/tf").size();
  client.wait(3);
  EXPECT_EQ(client.data("/tf").size(), sent);
}

}  // namespace
}  // namespace overfly::testing
