// Poses of cameras in recordings of ROS messages: those of the aircraft's body are wanted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flight/logs/ned_attitude.hpp"
#include "tests/flight/logs/mcap_fixture.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::Bytes;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::mcap_message;
using testing::Wire;

constexpr int kFrames = 20;
const Eigen::Quaterniond kFluFrd(0.0, 1.0, 0.0, 0.0);

/// T_world_body at a frame: to the east at 100 m, banked to the right, with its nose up.
Pose body_pose(int i) {
  const Eigen::Quaterniond R_ned_body = R_ned_body_from({0.5, 0.1, 1.5 + 0.02 * i});
  return {R_enu_ned() * R_ned_body, {2.5 * i, 7.0, 100.0}};
}

Bytes transform(std::int64_t t_ns, const char* parent, const char* child, const Pose& T) {
  testing::WireWriter message(Wire::kCdrLittle);
  message.number(std::uint32_t{1}).header(t_ns, parent).text(child);
  return message.vector(T.translation).quaternion(T.rotation).bytes();
}

/// How the transforms connect the camera with base_link.
enum class Tree {
  kCameraAbove,  ///< directly, as Overfly's exports do
  kByLink,       ///< from base_link by way of camera_link, as robots have it
  kSiblings,     ///< both below imu_link
};

/// What is recorded: by the channels /tf, /camera/truth, /odom, /camera/image_raw.
struct Recording {
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  int first_mount = kFrames;  ///< frame of the first transform to base_link
  Tree tree = Tree::kCameraAbove;
  const char* topic = "/camera/truth";
  const char* odometry_child = "camera_optical_frame";
  bool transforms = true;  ///< of the camera in the world
};

Bytes mount_message(std::int64_t t_ns, const Recording& recording) {
  const Pose T_camera_base =
      recording.T_body_camera.inverse() * Pose{kFluFrd, Eigen::Vector3d::Zero()};
  if (recording.tree == Tree::kCameraAbove) {
    return mcap_message(1, 0, transform(t_ns, "camera_optical_frame", "base_link", T_camera_base));
  }
  const Pose T_base_link{Eigen::Quaterniond::Identity(), {0.3, 0.0, 0.0}};
  const Pose T_link_camera = T_base_link.inverse() * T_camera_base.inverse();
  if (recording.tree == Tree::kSiblings) {
    Bytes siblings = mcap_message(1, 0, transform(t_ns, "imu_link", "base_link", T_base_link));
    append(
        siblings,
        mcap_message(
            1,
            0,
            transform(
                t_ns, "imu_link", "camera_optical_frame", T_base_link * T_camera_base.inverse())));
    return siblings;
  }
  Bytes bytes = mcap_message(1, 0, transform(t_ns, "base_link", "camera_link", T_base_link));
  append(bytes,
         mcap_message(1, 0, transform(t_ns, "camera_link", "camera_optical_frame", T_link_camera)));
  return bytes;
}

Bytes records_of(const Recording& recording) {
  Bytes records = testing::mcap_schema(1, "tf2_msgs/msg/TFMessage");
  append(records, testing::mcap_schema(2, "geometry_msgs/msg/PoseStamped"));
  append(records, testing::mcap_schema(3, "nav_msgs/msg/Odometry"));
  append(records, testing::mcap_channel(1, 1, "/tf", "cdr"));
  append(records, testing::mcap_channel(2, 2, recording.topic, "cdr"));
  append(records, testing::mcap_channel(3, 3, "/odom", "cdr"));
  for (int i = 0; i < kFrames; ++i) {
    const std::int64_t t_ns = kStartNs + i * kNsPerS / 30;
    if (i >= recording.first_mount) append(records, mount_message(t_ns, recording));
    const Pose T_world_camera = body_pose(i) * recording.T_body_camera;
    if (recording.transforms) {
      append(records,
             mcap_message(1, 0, transform(t_ns, "world", "camera_optical_frame", T_world_camera)));
    }
    const auto& [R, p] = T_world_camera;
    append(records,
           mcap_message(2, 0, testing::pose_stamped(Wire::kCdrLittle, t_ns, p, R, "world")));
    append(records,
           mcap_message(
               3,
               0,
               testing::odometry(Wire::kCdrLittle, t_ns, p, R, "world", recording.odometry_child)));
  }
  return records;
}

class CameraPosesOfLogs : public Mcap {
 protected:
  void expect_body(const OpenedLog& log, const std::string& source) {
    const auto trajectory = read_log_trajectory(log, {source, {}, {}});
    ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
    ASSERT_EQ(trajectory->poses.size(), std::size_t{kFrames});
    for (int i = 0; i < kFrames; ++i) {
      const LogPose& pose = trajectory->poses[static_cast<std::size_t>(i)];
      const Pose expected = body_pose(i);
      const Eigen::Vector3d p_enu = R_enu_ned() * pose.position;
      EXPECT_LT((p_enu - expected.translation).norm(), 1e-9) << source << " " << i;
      EXPECT_LT(rotation_angle_rad(R_enu_ned() * pose.R_ned_body, expected.rotation), 1e-6)
          << source << " " << i;
    }
  }
};

TEST_F(CameraPosesOfLogs, BecomeThoseOfTheBodyByTheMountInTheFile) {
  Recording recording;
  recording.T_body_camera = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY())) * R_body_camera_nadir(),
      {0.4, 0.0, 0.1}};
  for (const int first : {0, 7}) {
    for (const Tree tree : {Tree::kCameraAbove, Tree::kByLink, Tree::kSiblings}) {
      recording.first_mount = first;
      recording.tree = tree;
      recording.transforms = tree == Tree::kCameraAbove;  // a frame has one parent
      recording.odometry_child =
          first == 0 ? "camera_optical_frame" : "/camera_optical_frame";  // as tf of ROS 1
      const auto log = open_bytes(whole_file(records_of(recording)));
      ASSERT_TRUE(log.ok()) << log.error().message;
      EXPECT_THAT(log->warnings, IsEmpty());
      expect_body(*log, "/camera/truth");
      expect_body(*log, "/odom");
    }
  }
}

TEST_F(CameraPosesOfLogs, AreOfACameraThatLooksDownWhereNoMountIsStated) {
  const auto log = open_bytes(whole_file(records_of({})));
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_THAT(log->warnings,
              Contains(HasSubstr("/camera/truth has the poses of the camera camera_optical_frame, "
                                 "and no transform between base_link and it states")));
  expect_body(*log, "/camera/truth");
  expect_body(*log, "/odom");
}

TEST_F(CameraPosesOfLogs, OfEstimatesAreThoseOfTheFirstCamera) {
  Recording recording;
  recording.first_mount = 3;
  recording.topic = "/estimates/feature/pose_world";
  const auto log = open_bytes(whole_file(records_of(recording)));
  ASSERT_TRUE(log.ok()) << log.error().message;
  expect_body(*log, recording.topic);
}

/// A tracking system may name its topic in the same way, and has the pose of a body.
TEST_F(CameraPosesOfLogs, AreExpectedOnlyWhereTheCameraIsNamed) {
  Recording recording;
  recording.T_body_camera = {kFluFrd, Eigen::Vector3d::Zero()};  // forward-left-up: base_link
  for (const bool transforms : {false, true}) {
    recording.transforms = transforms;
    recording.topic = "/aircraft/truth";
    const auto log = open_bytes(whole_file(records_of(recording)));
    ASSERT_TRUE(log.ok()) << log.error().message;
    expect_body(*log, "/aircraft/truth");
  }
}

}  // namespace
}  // namespace overfly::flight::logs
