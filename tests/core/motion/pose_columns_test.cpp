// Trajectory files with named columns.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/trajectory_io.hpp"
#include "tests/support/support.hpp"

namespace overfly {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TemporaryFolder;
using testing::write_text;

Result<TrajectoryFile> read_csv(const std::string& text) {
  const TemporaryFolder folder;
  write_text(folder.path() / "poses.csv", text);
  return read_trajectory(folder.path() / "poses.csv");
}

TrajectoryFile read_good(const std::string& text) {
  const Result<TrajectoryFile> file = read_csv(text);
  EXPECT_TRUE(file.ok()) << text << (file.ok() ? "" : file.error().message);
  return file.ok() ? *file : TrajectoryFile{};
}

std::string refused(const std::string& text) {
  const Result<TrajectoryFile> file = read_csv(text);
  EXPECT_FALSE(file.ok()) << text;
  EXPECT_TRUE(file.ok() || file.error().code == ErrorCode::kUnreadable);
  return file.ok() ? "" : file.error().message;
}

TEST(PoseColumns, AreFoundByTheirNamesInAnyOrder) {
  const TrajectoryFile file = read_good(
      "name,qw,qx,qy,qz,x,y,z,t\n"
      "a,0.6,0.8,0,0,1,2,3,0.5\n"
      "b,1,0,0,0,4,5,6,1.5\n");
  EXPECT_EQ(file.format, TrajectoryFormat::kCsv);
  EXPECT_TRUE(file.has_times);
  ASSERT_EQ(file.trajectory.size(), 2U);
  const StampedPose& first = file.trajectory.poses()[0];
  EXPECT_EQ(first.t_ns, 500'000'000);
  EXPECT_EQ(first.pose.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(first.pose.rotation.w(), 0.6, 1e-15);
  EXPECT_NEAR(first.pose.rotation.x(), 0.8, 1e-15);
  EXPECT_EQ(file.trajectory.poses()[1].t_ns, 1'500'000'000);
}

TEST(PoseColumns, HaveTheNamesThatProgramsGiveThem) {
  const std::string values = "\n2,1,2,3,0.8,0,0,0.6\n";  // x y z w
  for (const char* names :
       {"t,x,y,z,qx,qy,qz,qw",
        "Time (s),X [m],Y [m],Z [m],q_x,q_y,q_z,q_w",
        "\"timestamp\",\"tx\",\"ty\",\"tz\",\"quat_x\",\"quat_y\",\"quat_z\",\"quat_w\"",
        "time_s,east_m,north_m,up_m,quaternion.x,quaternion.y,quaternion.z,quaternion.w",
        "stamp,pose.position.x,pose.position.y,pose.position.z,pose.orientation.x,"
        "pose.orientation.y,pose.orientation.z,pose.orientation.w",
        "sec,p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_x [],q_RS_y [],q_RS_z [],q_RS_w []"}) {
    const TrajectoryFile file = read_good(names + values);
    ASSERT_EQ(file.trajectory.size(), 1U) << names;
    const StampedPose& pose = file.trajectory.poses()[0];
    EXPECT_EQ(pose.t_ns, 2'000'000'000) << names;
    EXPECT_EQ(pose.pose.translation, Eigen::Vector3d(1, 2, 3)) << names;
    EXPECT_NEAR(pose.pose.rotation.w(), 0.6, 1e-15) << names;
  }
}

TEST(PoseColumns, HaveTimesInTheUnitThatTheNameSays) {
  const auto time = [](const std::string& name, const std::string& value) {
    const TrajectoryFile file =
        read_good(name + ",x,y,z,qx,qy,qz,qw\n" + value + ",0,0,0,0,0,0,1\n");
    return file.trajectory.empty() ? 0 : file.trajectory.poses()[0].t_ns;
  };
  EXPECT_EQ(time("timestamp_ns", "1403636579763555585"), 1'403'636'579'763'555'585);
  EXPECT_EQ(time("t [us]", "1403636579763555.585"), 1'403'636'579'763'555'585);
  EXPECT_EQ(time("time_ms", "1403636579763.555585"), 1'403'636'579'763'555'585);
  EXPECT_EQ(time("t", "1403636579.763555585"), 1'403'636'579'763'555'585);
  // Nanoseconds in a column that does not say so are no seconds.
  EXPECT_THAT(refused("timestamp,x,y,z,qx,qy,qz,qw\n1403636579763555584,0,0,0,0,0,0,1\n"),
              HasSubstr("magnitude must be below 9.2e9 s"));
  EXPECT_THAT(refused("t [h],x,y,z,qx,qy,qz,qw\n1,0,0,0,0,0,0,1\n"),
              AllOf(HasSubstr(":1: column 1 = 't [h]'"), HasSubstr("s, ms, us or ns")));
}

TEST(PoseColumns, FirstTimeCounts) {
  // As in a data set that `overfly export --format png` writes.
  const TrajectoryFile file = read_good(
      "frame,t_ns,stamp_ns,file,p_world_camera_x_m,p_world_camera_y_m,p_world_camera_z_m,"
      "q_world_camera_x,q_world_camera_y,q_world_camera_z,q_world_camera_w\n"
      "0,5,7000,a.png,1,2,3,0,0,0,1\n");
  ASSERT_EQ(file.trajectory.size(), 1U);
  EXPECT_EQ(file.trajectory.poses()[0].t_ns, 5);
  EXPECT_EQ(file.trajectory.poses()[0].pose.translation, Eigen::Vector3d(1, 2, 3));
}

TEST(PoseColumns, WithoutValuesAreGaps) {
  const TrajectoryFile file = read_good(
      "t,x,y,z,qx,qy,qz,qw,state\n"
      "2,3,0,0,0,0,0,1,good\n"
      "1,nan,NaN,,null,nan,nan,nan,lost\n"
      "0,1,0,0,0,0,0,1,good\n");
  EXPECT_EQ(file.trajectory.size(), 2U);
  EXPECT_EQ(file.unknown_poses, 1U);
  EXPECT_FALSE(file.trajectory.at(500'000'000));
  EXPECT_EQ(file.warnings.size(), 1U) << "sorted by time";
  EXPECT_THAT(refused("t,x,y,z,qx,qy,qz,qw\n1,,,,,,,\n"), HasSubstr("only gaps"));
}

TEST(PoseColumns, NameWhatIsMissingTwiceOrWrong) {
  EXPECT_THAT(refused("t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n"),
              HasSubstr(":1: there must be columns named qx qy qz qw"));
  EXPECT_THAT(refused("a,b,c\n1,2,3\n"), HasSubstr("named time x y z qx qy qz qw"));
  EXPECT_THAT(refused("t,x,tx,y,z,qx,qy,qz,qw\n"), HasSubstr("column 2 is the x already"));
  EXPECT_THAT(refused("t,x [ft],y,z,qx,qy,qz,qw\n"), HasSubstr("a position must be in m"));
  EXPECT_THAT(refused("t,x,y,z,qx,qy,qz,qw\n"), HasSubstr("contains no poses"));
  const std::string names = "t,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n";
  EXPECT_THAT(refused(names + "1,0,0,0,0,0,0\n"), HasSubstr(":3: 7 columns: must be 8"));
  EXPECT_THAT(refused(names + "1,0,nan,0,0,0,0,1\n"), HasSubstr(":3: column 3 = 'nan'"));
  EXPECT_THAT(refused(names + "1,0,0,0,0,0,0,2\n"), HasSubstr("quaternion's norm"));
  EXPECT_THAT(refused(names + "soon,0,0,0,0,0,0,1\n"), HasSubstr("must be a time in seconds"));
}

TEST(PoseColumns, AreDetectedWithoutReadingTheFile) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "poses.csv";
  const auto detected = [&](const std::string& text) {
    write_text(file, text);
    const Result<TrajectoryFormat> format = detect_trajectory(file);
    return format ? std::string(to_string(*format)) : "";
  };
  const std::string names = "t,x,y,z,qx,qy,qz,qw\n";
  EXPECT_EQ(detected(names + "0,0,0,0,0,0,0,1\n" + std::string(200'000, 'x')), "csv");
  EXPECT_EQ(detected(names + "0,nan,nan,nan,nan,nan,nan,nan\n"), "csv");
  EXPECT_EQ(detected(names + "0,0,0,0,0,0,0,2\n"), "");
  EXPECT_EQ(detected("time,latitude,longitude,altitude\n0,1,2,3\n"), "");
}

}  // namespace
}  // namespace overfly
