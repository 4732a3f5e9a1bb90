// Masters and nodes that are not there, come late, or go.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <future>
#include <thread>

#include "middleware/ros1/findings.hpp"
#include "middleware/ros1/master.hpp"
#include "middleware/ros1/node.hpp"
#include "tests/vo_bridges/ros1/ros_world.hpp"

namespace overfly::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

void expect_error(const Result<std::unique_ptr<VoPort>>& port,
                  ErrorCode code,
                  const std::string& text) {
  ASSERT_FALSE(port.ok());
  EXPECT_EQ(port.error().code, code) << port.error().message;
  EXPECT_THAT(port.error().message, HasSubstr(text));
}

bool is_tracked(const Result<VoEstimate>& estimate) {
  return estimate.ok() && estimate.value().sample.state == TrackingState::kTracking;
}

TEST(Ros1Options, AreCheckedByName) {
  const auto refused = [](auto change) {
    Ros1EstimatorOptions options;
    change(options);
    const auto port = create_ros1_estimator(options);
    return port.ok() ? std::string() : port.error().message;
  };
  using Options = Ros1EstimatorOptions;
  EXPECT_THAT(refused([](Options& o) { o.master_uri = "localhost:11311"; }),
              AllOf(HasSubstr("master_uri"), HasSubstr("http://HOST:PORT")));
  EXPECT_THAT(refused([](Options& o) { o.master_uri = "http://host:70000"; }),
              HasSubstr("master_uri"));
  EXPECT_THAT(refused([](Options& o) { o.master_uri = "http://host/:1"; }),
              HasSubstr("master_uri"));
  EXPECT_THAT(refused([](Options& o) { o.image_topic = ""; }), HasSubstr("image_topic"));
  EXPECT_THAT(refused([](Options& o) { o.pose_topic = "/a b"; }), HasSubstr("pose_topic"));
  EXPECT_THAT(refused([](Options& o) { o.camera_info_topic = "~info"; }),
              HasSubstr("camera_info_topic"));
  EXPECT_THAT(refused([](Options& o) { o.debug_image_topic = "/a//b"; }),
              HasSubstr("debug_image_topic"));
  EXPECT_THAT(refused([](Options& o) { o.node_name = "over/fly"; }), HasSubstr("node_name"));
  EXPECT_THAT(refused([](Options& o) { o.queue_size = 0; }), HasSubstr("queue_size = 0"));
  EXPECT_THAT(refused([](Options& o) { o.start_timeout_s = -1.0; }), HasSubstr("start_timeout_s"));
  EXPECT_THAT(refused([](Options& o) { o.answer_timeout_s = 1e9; }), HasSubstr("answer_timeout_s"));
  EXPECT_THAT(refused([](Options& o) { o.camera_frame = ""; }), HasSubstr("camera_frame"));
  EXPECT_THAT(refused([](Options& o) { o.parameters["levels"] = 8.0; }),
              HasSubstr("parameter_namespace"));
  EXPECT_THAT(refused([](Options& o) { o.pose_topic = "camera/image_raw"; }),
              HasSubstr("pose_topic = camera/image_raw: must not be the image_topic"));
  EXPECT_THAT(refused([](Options& o) { o.debug_image_topic = o.image_topic; }),
              HasSubstr("must not be the image_topic"));
  EXPECT_THAT(refused([](Options& o) {
                o.pose_type = Ros1PoseType::kTf;
                o.publish_tf = true;
              }),
              HasSubstr("publish_tf"));
}

TEST(Ros1Faults, SaysThatThereIsNoMaster) {
  RosMaster::instance().stop();
  Ros1EstimatorOptions options = fresh_options();
  options.start_timeout_s = 0.3;
  const auto before = std::chrono::steady_clock::now();
  expect_error(create_ros1_estimator(options), ErrorCode::kNotFound, "no ROS master answers at");
  EXPECT_LT(std::chrono::steady_clock::now() - before, 10s);
}

TEST(Ros1Faults, LeavesHandlersOfSignalsAlone) {
  ROS_MASTER_OR_SKIP();
  const auto handler = [](int /*signal*/) {};
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options);
  const auto port = created(options);
  EXPECT_EQ(std::signal(SIGINT, SIG_DFL), static_cast<void (*)(int)>(handler));
  EXPECT_EQ(std::signal(SIGTERM, SIG_DFL), static_cast<void (*)(int)>(handler));
}

TEST(Ros1Node, IsStartedAfterAStartThatFailed) {
  ROS_MASTER_OR_SKIP();
  if (ros1::Node::alive()) GTEST_SKIP() << "this process is a node already, by another suite";
  const auto master = ros1::parse_xml_rpc_address(RosMaster::instance().uri());
  ASSERT_TRUE(master);
  for (int i = 0; i < 2; ++i) {
    const auto failed = ros1::Node::join(*master, "over~fly", 10s);
    ASSERT_FALSE(failed.ok());
    EXPECT_EQ(failed.error().code, ErrorCode::kInternal);
    EXPECT_THAT(failed.error().message,
                AllOf(HasSubstr("ROS cannot be started: "), HasSubstr("over~fly")));
  }
  const auto node = ros1::Node::join(*master, "overfly_again", 10s);
  ASSERT_TRUE(node.ok()) << node.error().message;
  EXPECT_EQ((*node)->name(), "/overfly_again");
}

TEST(Ros1Faults, SaysThatNobodySubscribes) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.start_timeout_s = 0.5;
  expect_error(create_ros1_estimator(options),
               ErrorCode::kNotFound,
               "nobody subscribes to " + options.image_topic);
}

TEST(Ros1Faults, WaitsForALateSubscriber) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  auto port = std::async(std::launch::async, [&] { return create_ros1_estimator(options); });
  EXPECT_EQ(port.wait_for(500ms), std::future_status::timeout);
  const TestNode node(options);
  auto late = port.get();
  ASSERT_TRUE(late.ok()) << late.error().message;
  EXPECT_TRUE(is_tracked((*late)->track(grey_frames(1).front())));
  EXPECT_TRUE(logs(**late, "subscribed to " + options.image_topic));
}

TEST(Ros1Faults, RefusesASecondMaster) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options);
  const auto port = created(options);
  options.master_uri = "http://127.0.0.1:1";
  expect_error(create_ros1_estimator(options), ErrorCode::kConflict, RosMaster::instance().uri());
}

TEST(Ros1Faults, RefusesATopicThatAnotherEstimatorHas) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options);
  {
    const auto port = created(options);
    expect_error(create_ros1_estimator(options), ErrorCode::kConflict, options.image_topic);
  }
  EXPECT_TRUE(is_tracked(created(options)->track(grey_frames(1).front())))
      << "one run after another may have it";
}

TEST(Ros1Faults, RefusesWhatWouldMakeEstimatorsAnswerForEachOther) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions first = fresh_options();
  const TestNode node(first);
  const auto port = created(first);
  using Options = Ros1EstimatorOptions;
  for (const auto field :
       {&Options::camera_info_topic, &Options::pose_topic, &Options::debug_image_topic}) {
    Options second = fresh_options();
    second.*field = (first.*field).substr(1);  // the same one without its slash
    expect_error(create_ros1_estimator(second), ErrorCode::kConflict, first.*field);
  }
  Options crossed = fresh_options();
  crossed.debug_image_topic = first.image_topic;
  expect_error(create_ros1_estimator(crossed), ErrorCode::kConflict, "debug_image_topic = ");
}

TEST(Ros1Faults, RefusesATransformThatAnotherEstimatorHas) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions first = fresh_options();
  first.pose_type = Ros1PoseType::kTf;
  const TestNode node(first);
  const auto port = created(first);
  Ros1EstimatorOptions second = fresh_options();
  second.pose_type = Ros1PoseType::kTf;
  second.vo_frame = "/" + first.vo_frame;
  expect_error(create_ros1_estimator(second), ErrorCode::kConflict, "camera in world on /tf");
  second.vo_frame = "map";
  const TestNode other(second);
  EXPECT_TRUE(is_tracked(created(second)->track(grey_frames(1).front())));
}

TEST(Ros1Faults, EndsInLockstepWhenTheNodeDies) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.answer_timeout_s = 3.0;
  TestNode node(options);
  const auto port = created(options);
  const std::vector<VoFrame> frames = grey_frames(4);
  EXPECT_TRUE(is_tracked(port->track(frames[0])));
  node.kill();
  EXPECT_TRUE(logs(*port, "left " + options.image_topic));
  const auto gone = port->track(frames[1]);
  ASSERT_FALSE(gone.ok());
  EXPECT_EQ(gone.error().code, ErrorCode::kInternal);
  EXPECT_THAT(gone.error().message, HasSubstr("the estimator's node has ended"));
  EXPECT_FALSE(port->track(frames[2]).ok()) << "it is gone for good";
}

TEST(Ros1Faults, GoesOnByTheClockUntilTheNodeIsBack) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.lockstep = false;
  auto node = std::make_unique<TestNode>(options);
  const auto port = created(options);
  std::vector<VoFrame> frames = grey_frames(400);
  std::size_t next = 0;
  EXPECT_TRUE(wait_for([&] { return is_tracked(port->track(frames.at(next++))); }));
  node->kill();
  EXPECT_TRUE(logs(*port, "left " + options.image_topic));
  const auto alone = port->track(frames.at(next++));
  ASSERT_TRUE(alone.ok());
  EXPECT_EQ(alone->sample.state, TrackingState::kLost);
  EXPECT_EQ(alone->counters.at("unanswered"), 1.0);
  node = std::make_unique<TestNode>(options);
  EXPECT_TRUE(logs(*port, "subscribed to " + options.image_topic));
  EXPECT_TRUE(
      wait_for([&] { return next < frames.size() && is_tracked(port->track(frames[next++])); }));
}

TEST(Ros1Faults, OutlivesTheMasterAndFindsTheNextOne) {
  ROS_MASTER_OR_SKIP();
  RosMaster& master = RosMaster::instance();
  const Ros1EstimatorOptions options = fresh_options();
  auto node = std::make_unique<TestNode>(options);
  const auto port = created(options);
  const std::vector<VoFrame> frames = grey_frames(10);
  EXPECT_TRUE(is_tracked(port->track(frames[0])));

  master.stop();
  EXPECT_TRUE(logs(*port, "no longer answers"));
  EXPECT_TRUE(is_tracked(port->track(frames[1]))) << "what is connected goes on";

  master.start();
  EXPECT_TRUE(logs(*port, "was restarted"));
  EXPECT_TRUE(is_tracked(port->track(frames[2])));
  node->kill();
  EXPECT_TRUE(logs(*port, "left " + options.image_topic));
  node = std::make_unique<TestNode>(options);
  EXPECT_TRUE(logs(*port, "subscribed to " + options.image_topic))
      << "the new master knows our topics";
  EXPECT_TRUE(wait_for([&] {
    static std::size_t next = 3;
    return next < frames.size() && is_tracked(port->track(frames[next++]));
  }));
}

TEST(Ros1Faults, EndsWhenMasterAndNodeAreGone) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  TestNode node(options);
  const auto port = created(options);
  const std::vector<VoFrame> frames = grey_frames(3);
  EXPECT_TRUE(is_tracked(port->track(frames[0])));
  RosMaster::instance().stop();
  node.kill();
  EXPECT_TRUE(logs(*port, "no longer answers"));
  EXPECT_TRUE(wait_for([&] {
    const auto gone = port->track(frames[1]);
    return !gone.ok() && gone.error().message.find("does not answer either") != std::string::npos;
  }));
}

TEST(Ros1Findings, SayWhatIsThere) {
  ROS_MASTER_OR_SKIP();
  setenv("ROS_MASTER_URI", RosMaster::instance().uri().c_str(), 1);
  ros1::Findings findings = ros1::findings();
  EXPECT_TRUE(findings.built_in);
  EXPECT_TRUE(findings.works);
  EXPECT_THAT(findings.finding, HasSubstr("a master answers at " + RosMaster::instance().uri()));
  setenv("ROS_MASTER_URI", "elsewhere", 1);
  findings = ros1::findings();
  EXPECT_FALSE(findings.works);
  EXPECT_THAT(findings.finding, HasSubstr("ROS_MASTER_URI = 'elsewhere'"));
  unsetenv("ROS_MASTER_URI");
}

}  // namespace
}  // namespace overfly::testing
