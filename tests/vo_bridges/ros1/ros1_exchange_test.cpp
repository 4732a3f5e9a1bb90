// What goes back and forth between the door and a node.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <utility>

#include "core/measure/crc32.hpp"
#include "tests/vo_bridges/ros1/ros_world.hpp"
#include "vo_bridges/pose_intake.hpp"
#include "vo_bridges/process_usage.hpp"
#include "vo_bridges/ros1/ros1_option_check.hpp"

namespace overfly::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

VoEstimate tracked(VoPort& port, const VoFrame& frame) {
  auto estimate = port.track(frame);
  if (!estimate) throw std::runtime_error(estimate.error().message);
  return std::move(estimate).value();
}

/// What the test's node answers: that image, that focal length, and a turn about x.
void expect_proof(const VoEstimate& estimate, const VoFrame& frame) {
  ASSERT_EQ(estimate.sample.state, TrackingState::kTracking);
  const Pose& T = estimate.sample.T_vo_camera;
  // CRC-32 and a focal length are exact in a double; an inversion costs some last places of 4e9.
  constexpr double kRounding = 1e-4;
  EXPECT_NEAR(T.translation.x(), crc32_of(*frame.image), kRounding);
  EXPECT_NEAR(T.translation.y(), frame.intrinsics.fx_px, kRounding);
  EXPECT_NEAR(T.translation.z(), 3.0, kRounding);
  const Eigen::Quaterniond turned(
      Eigen::AngleAxisd(0.01 * frame.image->data[0], Eigen::Vector3d::UnitX()));
  EXPECT_NEAR(rotation_angle_rad(T.rotation, turned), 0.0, 1e-9);
}

class Ros1PoseTypes : public ::testing::TestWithParam<Ros1PoseType> {};

TEST_P(Ros1PoseTypes, CarryThePoseOfEachFrame) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.pose_type = GetParam();
  options.vo_frame = std::string("map_") + ros1::to_string(GetParam());
  const TestNode node(options);
  const auto port = created(options);
  for (const VoFrame& frame : grey_frames(20)) expect_proof(tracked(*port, frame), frame);
}

INSTANTIATE_TEST_SUITE_P(All,
                         Ros1PoseTypes,
                         ::testing::Values(Ros1PoseType::kPoseStamped,
                                           Ros1PoseType::kPoseWithCovarianceStamped,
                                           Ros1PoseType::kOdometry,
                                           Ros1PoseType::kTf),
                         [](const auto& tested) {
                           return std::string(ros1::to_string(tested.param));
                         });

TEST(Ros1Exchange, InvertsPosesOfTheWorldInTheCamera) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.pose_is_camera_from_world = true;
  const TestNode node(options, {"invert=1"});
  const auto port = created(options);
  for (const VoFrame& frame : grey_frames(3)) expect_proof(tracked(*port, frame), frame);
}

TEST(Ros1Exchange, TurnsBodyAxesIntoOpticalOnes) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.pose_in_body_axes = true;
  options.pose_is_camera_from_world = true;
  const TestNode node(options, {"body_axes=1", "invert=1"});
  const auto port = created(options);
  for (const VoFrame& frame : grey_frames(3)) expect_proof(tracked(*port, frame), frame);
}

/// As the test node states it.
Matrix6d stated_covariance() {
  Matrix6d P = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) P(i, i) = 0.25 * (i + 1);
  P(0, 1) = P(1, 0) = 0.125;
  return P;
}

TEST(Ros1Exchange, CarriesTheCovariance) {
  ROS_MASTER_OR_SKIP();
  for (const Ros1PoseType type :
       {Ros1PoseType::kPoseWithCovarianceStamped, Ros1PoseType::kOdometry}) {
    Ros1EstimatorOptions options = fresh_options();
    options.pose_type = type;
    options.pose_in_body_axes = true;  // of the camera: the covariance is in the parent's
    const TestNode node(options, {"body_axes=1", "covariance=1"});
    const auto port = created(options);
    for (const VoFrame& frame : grey_frames(3)) {
      const VoEstimate estimate = tracked(*port, frame);
      ASSERT_NE(estimate.sample.covariance, nullptr);
      EXPECT_EQ(estimate.sample.covariance->matrix, stated_covariance());
    }
  }
}

TEST(Ros1Exchange, InvertsTheCovarianceWithThePose) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.pose_type = Ros1PoseType::kOdometry;
  options.pose_is_camera_from_world = true;
  const TestNode node(options, {"invert=1", "covariance=1"});
  const auto port = created(options);
  for (const VoFrame& frame : grey_frames(2)) {
    const VoEstimate estimate = tracked(*port, frame);
    ASSERT_NE(estimate.sample.covariance, nullptr);
    const Matrix6d expected =
        inverted_covariance(estimate.sample.T_vo_camera.inverse(), stated_covariance());
    EXPECT_TRUE(estimate.sample.covariance->matrix.isApprox(expected, 1e-9));
  }
}

TEST(Ros1Exchange, KeepsThePoseOfAnInvalidCovariance) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.pose_type = Ros1PoseType::kPoseWithCovarianceStamped;
  const TestNode node(options, {"covariance=2"});
  const auto port = created(options);
  for (const VoFrame& frame : grey_frames(2)) {
    const VoEstimate estimate = tracked(*port, frame);
    expect_proof(estimate, frame);
    EXPECT_EQ(estimate.sample.covariance, nullptr);
    EXPECT_TRUE(estimate.sample.covariance_left_out);
  }
  EXPECT_TRUE(logs(*port, "covariance: values (4, 1) = 0.0"));
}

TEST(Ros1Exchange, PublishesSamplesOfSensors) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.publish_sensors = true;
  const TestNode node(options);
  const auto port = created(options);
  std::vector<VoFrame> frames = grey_frames(4);
  for (std::size_t k = 1; k < frames.size(); ++k) {
    for (int i = 0; i < 20; ++i) {  // more than the queue of the images
      frames[k].sensors.imu.push_back(
          {frames[k].t_ns - 1'000'000 * (20 - i), {0.0, 0.0, -9.75}, {0.0, 0.0, 0.5}});
    }
  }
  GpsSample none;
  none.t_ns = 250'000'000;
  none.fix = GpsFixType::kNone;
  GpsSample fix;
  fix.t_ns = 50'000'000;
  fix.place = geodetic_from_deg(39.5, -86.0, 210.5);
  frames[3].sensors.gps = {fix, none};
  for (const VoFrame& frame : frames) expect_proof(tracked(*port, frame), frame);
  // ROS time is the flight's plus one second; axes are forward-left-up.
  EXPECT_TRUE(node.says("fix 1.050 status 0 lat 39.5"));
  EXPECT_TRUE(node.says("fix 1.250 status -1"));
  EXPECT_TRUE(node.says("wz -0.5 az 9.75 base_link"));
  const auto count = [&] {
    const std::string said = node.output();
    int samples = 0;
    for (std::size_t at = said.find("imu "); at != std::string::npos;
         at = said.find("imu ", at + 1)) {
      ++samples;
    }
    return samples;
  };
  EXPECT_TRUE(wait_for([&] { return count() == 60; })) << count();
}

TEST(Ros1Exchange, TellsCalibrationTimeAndFrame) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.camera_frame = "camera_optical_frame";
  const TestNode node(options);
  const auto port = created(options);
  for (VoFrame frame : grey_frames(3)) {
    frame.distortion = {DistortionModel::kRadtan, {-0.05, 0.01, 0.002, -0.001, 0.003}};
    expect_proof(tracked(*port, frame), frame);
  }
  EXPECT_TRUE(node.says("image mono8 camera_optical_frame"));
  EXPECT_TRUE(node.says("camera_info 64 x 48 plumb_bob D -0.05 0.01 0.002 -0.001 0.003 K "));
  EXPECT_TRUE(node.says("clock 1.000000000")) << "0 means no time on ROS";
  EXPECT_TRUE(node.says("clock 1.032258065")) << "31 frames a second";
}

TEST(Ros1Exchange, IsPreparedBeforeTheFirstFrame) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options, {"wait_for_info=1"});  // and loads before it takes images
  const auto port = created(options);
  const std::vector<VoFrame> frames = grey_frames(3);
  VoFrame first = frames.front();
  first.image.reset();
  ASSERT_TRUE(port->prepare(first).ok());
  EXPECT_TRUE(logs(*port, "subscribed to " + options.image_topic));
  EXPECT_THAT(node.output(), ::testing::Not(HasSubstr("image mono8")));
  for (const VoFrame& frame : frames) expect_proof(tracked(*port, frame), frame);
  EXPECT_TRUE(node.says("clock 1.000000000"));
}

TEST(Ros1Exchange, KeepsTimeAboveZeroForStampsBeforeTheFlight) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options);
  const auto port = created(options);
  std::vector<VoFrame> frames = grey_frames(3);
  for (VoFrame& frame : frames) frame.t_ns -= 63'000'000'000;  // a fault's offset, and its jitter
  for (const VoFrame& frame : frames) expect_proof(tracked(*port, frame), frame);
  EXPECT_TRUE(node.says("clock 1.000000000"));
  EXPECT_TRUE(node.says("clock 1.032258065"));
}

TEST(Ros1Exchange, TakesStampsSince1970) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options);
  const auto port = created(options);
  VoFrame frame = grey_frames(1).front();
  frame.t_ns = std::int64_t{4'000'000'000} * 1'000'000'000;
  expect_proof(tracked(*port, frame), frame);
  EXPECT_TRUE(node.says("clock 4000000001.000000000"));
}

TEST(Ros1Exchange, RefusesStampsThatRosCannotSay) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options);
  const auto port = created(options);
  for (const std::int64_t t_s : {-5'000'000'000, 4'294'967'296}) {
    VoFrame frame = grey_frames(1).front();
    frame.t_ns = t_s * 1'000'000'000;
    const auto estimate = port->track(frame);
    ASSERT_FALSE(estimate.ok());
    EXPECT_EQ(estimate.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(estimate.error().message, HasSubstr("stamp of frame 0 = " + std::to_string(t_s)));
    EXPECT_THAT(estimate.error().message, HasSubstr("within 4294967296 s of 0"));
  }
}

TEST(Ros1Exchange, KeepsTimeFromOthersWhenToldSo) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.publish_clock = false;
  options.publish_tf = true;
  options.vo_frame = "map_of_looker_on";
  const TestNode node(options);
  const auto port = created(options);
  const std::vector<VoFrame> frames = grey_frames(600);
  // The door does not wait for subscribers of /tf, so the node misses what is sent before it is
  // connected.
  auto frame = frames.begin();
  const std::string transform = "tf map_of_looker_on -> camera x ";
  ASSERT_TRUE(wait_for([&] {
    if (frame == frames.end() - 1) return true;
    expect_proof(tracked(*port, *frame), *frame);
    ++frame;
    return node.output().find(transform) != std::string::npos;
  }));
  expect_proof(tracked(*port, *frame), *frame);
  EXPECT_TRUE(node.says(transform + std::to_string(crc32_of(*frame->image))));
  EXPECT_THAT(node.output(), ::testing::Not(HasSubstr("clock")));
}

TEST(Ros1Exchange, TakesDebugImagesOfManyEncodingsAndSizes) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options, {"debug_scale=2"});
  const auto port = created(options);
  port->set_debug(true);
  const VoEstimate estimate = tracked(*port, grey_frames(1).front());
  ASSERT_TRUE(estimate.debug_image);
  EXPECT_EQ(estimate.debug_image->width_px, 64) << "twice as large as the frame: halved";
  EXPECT_EQ(estimate.debug_image->data[0], 77);
}

TEST(Ros1Exchange, SaysWhatIsWrongWithADebugImage) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options, {"debug_encoding=bayer_rggb8"});
  const auto port = created(options);
  port->set_debug(true);
  EXPECT_FALSE(tracked(*port, grey_frames(1).front()).debug_image);
  EXPECT_THAT(port->take_log(), Contains(HasSubstr("bayer_rggb8")));
}

TEST(Ros1Exchange, WaitsForNoDebugImageByTheClock) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  const std::string topic = std::exchange(options.debug_image_topic, "");
  const TestNode node(options);  // draws none
  options.debug_image_topic = topic;
  options.lockstep = false;
  const auto port = created(options);
  port->set_debug(true);
  const std::vector<VoFrame> frames = grey_frames(3);
  ASSERT_TRUE(port->prepare(frames[0]).ok());
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(tracked(*port, frames[0]).debug_image);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(800));
}

TEST(Ros1Exchange, LosesNoFrameToANodeThatNeedsTheCalibrationFirst) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options, {"wait_for_info=1"});
  const auto port = created(options);
  for (const VoFrame& frame : grey_frames(5)) expect_proof(tracked(*port, frame), frame);
}

TEST(Ros1Exchange, WaitsInLockstepForASlowNode) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options, {"delay_ms=150"});  // of frames that are 32 ms apart
  const auto port = created(options);
  for (const VoFrame& frame : grey_frames(5)) expect_proof(tracked(*port, frame), frame);
}

TEST(Ros1Exchange, GoesByTheClockForANodeThatAnswersSomeFrames) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.lockstep = false;
  options.answer_timeout_s = 600.0;  // which nothing waits for
  const TestNode node(options, {"every=3"});
  const auto port = created(options);
  int answered = 0;
  int unanswered = 0;
  for (const VoFrame& frame : grey_frames(30)) {
    const VoEstimate estimate = tracked(*port, frame);
    const bool missed = estimate.counters.count("unanswered") != 0;
    unanswered += missed ? 1 : 0;
    answered += estimate.sample.state == TrackingState::kTracking ? 1 : 0;
    EXPECT_EQ(missed, estimate.sample.state != TrackingState::kTracking);
  }
  EXPECT_GE(unanswered, 20) << "of 30 frames the node answers 10";
  EXPECT_GE(answered, 5) << "some may be late on a busy machine";
}

TEST(Ros1Exchange, IsInitialisingUntilTheFirstPoseAndLostWithoutOne) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.answer_timeout_s = 0.3;
  const TestNode node(options, {"silent_until=4", "every=2"});
  const auto port = created(options);
  const std::vector<VoFrame> frames = grey_frames(9);
  std::vector<TrackingState> states;
  states.reserve(frames.size());
  for (const VoFrame& frame : frames) states.push_back(tracked(*port, frame).sample.state);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(states[i], TrackingState::kInitialising) << i;
  EXPECT_EQ(states.back(), TrackingState::kLost) << "the ninth image has no pose";
}

TEST(Ros1Exchange, CountsPosesThatBelongToNoFrame) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.answer_timeout_s = 0.3;
  const TestNode node(options, {"stamp_off_s=5"});
  const auto port = created(options);
  EXPECT_EQ(tracked(*port, grey_frames(1).front()).sample.state, TrackingState::kInitialising);
  EXPECT_TRUE(logs(*port, "1 poses have a stamp of no frame"));
}

TEST(Ros1Exchange, TakesAPoseThatIsNoneForALostTrack) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options, {"bad_pose=1"});
  const auto port = created(options);
  const VoEstimate estimate = tracked(*port, grey_frames(1).front());
  EXPECT_EQ(estimate.sample.state, TrackingState::kLost);
  EXPECT_EQ(estimate.counters.count("unanswered"), 0U) << "it did answer";
  EXPECT_THAT(port->take_log(), Contains(HasSubstr("warning: frame 0: the pose is not finite")));
}

TEST(Ros1Exchange, GivesUpAnEstimatorWithoutAUsablePose) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  const TestNode node(options, {"bad_pose=1"});
  const auto port = created(options);
  const auto frames = grey_frames(PoseIntake::kMostInARow + 1);
  for (int i = 0; i + 1 < PoseIntake::kMostInARow; ++i) {
    EXPECT_EQ(tracked(*port, frames[i]).sample.state, TrackingState::kLost) << i;
  }
  for (int i = PoseIntake::kMostInARow - 1; i <= PoseIntake::kMostInARow; ++i) {
    const Result<VoEstimate> gone = port->track(frames[i]);
    ASSERT_FALSE(gone.ok());
    EXPECT_EQ(gone.error().code, ErrorCode::kInternal);
    EXPECT_THAT(gone.error().message, HasSubstr("30 answers in a row had no usable pose"));
  }
}

TEST(Ros1Exchange, SetsAndReadsParametersOfTheNode) {
  ROS_MASTER_OR_SKIP();
  Ros1EstimatorOptions options = fresh_options();
  options.parameter_namespace = "/slam_parameters";
  options.parameters = {{"levels", 8.0},
                        {"scale", 1.2},
                        {"loop_closing", false},
                        {"tracker/mode", std::string("fast")}};
  const TestNode node(options);
  const auto port = created(options);
  const auto parameters = port->effective_parameters();
  EXPECT_EQ(parameters.at("levels"), "8");
  EXPECT_EQ(parameters.at("scale"), "1.2");
  EXPECT_EQ(parameters.at("loop_closing"), "false");
  EXPECT_EQ(parameters.at("tracker/mode"), "fast");
  EXPECT_EQ(parameters.at("ros1.pose_type"), "pose_stamped");
}

TEST(Ros1Exchange, TellsWhatTheNodesProcessUses) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options = fresh_options();
  TestNode node(options);
  const auto port = created(options);
  const std::vector<VoFrame> frames = grey_frames(20);
  ASSERT_TRUE(port->prepare(frames[0]).ok());
  ASSERT_TRUE(wait_for([&] { return port->resource_use().has_value(); }));
  for (const VoFrame& frame : frames) expect_proof(tracked(*port, frame), frame);
  const std::optional<ResourceUse> use = port->resource_use();
  ASSERT_TRUE(use);
  EXPECT_TRUE(use->own_process);
  EXPECT_NEAR(use->peak_memory_mb, usage_of(node.pid())->peak_memory_mb, 1.0);
  EXPECT_GE(use->cpu_s, 0.0);
  EXPECT_LE(use->cpu_s, usage_of(node.pid())->cpu_s);
  node.kill();
  EXPECT_EQ(port->resource_use()->peak_memory_mb, use->peak_memory_mb) << "as it was";
}

TEST(Ros1Exchange, FeedsTwoNodesFromOneProcess) {
  ROS_MASTER_OR_SKIP();
  const Ros1EstimatorOptions options[] = {fresh_options(), fresh_options()};
  const TestNode nodes[] = {TestNode(options[0]), TestNode(options[1])};
  const auto one = created(options[0]);
  const auto other = created(options[1]);
  for (const VoFrame& frame : grey_frames(5)) {
    expect_proof(tracked(*one, frame), frame);
    expect_proof(tracked(*other, frame), frame);
  }
  EXPECT_THAT(other->take_log(), Contains(HasSubstr("another estimator")));
}

}  // namespace
}  // namespace overfly::testing
