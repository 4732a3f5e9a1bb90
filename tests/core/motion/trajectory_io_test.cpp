#include "core/motion/trajectory_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <random>

#include "tests/support/support.hpp"

namespace overfly {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::read_text;
using testing::TemporaryFolder;
using testing::write_text;

/// The error of reading a file of this text.
Error error_of(const std::string& text) {
  const TemporaryFolder folder;
  write_text(folder.path() / "poses.txt", text);
  const Result<TrajectoryFile> file = read_trajectory(folder.path() / "poses.txt");
  EXPECT_FALSE(file.ok());
  return file.ok() ? Error{} : file.error();
}

TrajectoryFile read_ok(const std::string& text) {
  const TemporaryFolder folder;
  write_text(folder.path() / "poses.txt", text);
  const Result<TrajectoryFile> file = read_trajectory(folder.path() / "poses.txt");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().message);
  return file.ok() ? *file : TrajectoryFile{};
}

TEST(TrajectoryIo, DetectsTheFormatFromTheFirstPose) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "poses.txt";
  const auto detected = [&](const std::string& text) {
    write_text(file, text);
    const Result<TrajectoryFormat> format = detect_trajectory(file);
    return format ? std::string(to_string(*format)) : "";
  };
  EXPECT_EQ(detected("# t x\n0 0 0 0 0 0 0 1\nnot read\n"), "tum");
  EXPECT_EQ(detected("0 nan nan nan nan nan nan nan\n"), "tum");
  EXPECT_EQ(detected("1 0 0 0 0 1 0 0 0 0 1 0\n"), "kitti");
  EXPECT_EQ(detected("#t\n1,2,3,4,1,0,0,0,5\n"), "euroc");
  EXPECT_EQ(detected("0 0 0 0 0 0 0 1\n" + std::string(200'000, 'x')), "tum");
  for (const char* text : {"", "# only\n", "0 0 0 0 0 0 0 2\n", "1,2,3\n", "words\n"}) {
    EXPECT_EQ(detected(text), "") << text;
  }
  EXPECT_EQ(detected(std::string(200'000, '1')), "");
  ASSERT_EQ(::mkfifo((folder.path() / "fifo").c_str(), 0600), 0);
  EXPECT_FALSE(detect_trajectory(folder.path() / "fifo").ok());
}

TEST(TrajectoryIo, KeepsToTheLimitsOfTheCaller) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "poses.txt";
  write_text(file, "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  EXPECT_TRUE(read_trajectory(file, {1000, 3}, nullptr).ok());
  const auto too_many = read_trajectory(file, {1000, 2}, nullptr);
  ASSERT_FALSE(too_many.ok());
  EXPECT_THAT(too_many.error().message, HasSubstr("must have at most 2 lines"));
  EXPECT_FALSE(read_trajectory(file, {40, 3}, nullptr).ok());
  const Error wide = error_of(std::string(1'000'000, ','));
  EXPECT_THAT(wide.message, HasSubstr("must have at most 4096 columns"));
  // A message does not repeat a field of any length.
  const Error field = error_of("0 0 0 0 0 0 0 " + std::string(1'000'000, 'x') + "\n");
  EXPECT_LT(field.message.size(), 1000U);
}

TEST(TrajectoryIo, GivesReadErrorsAsErrorsAndNeverWaits) {
  EXPECT_EQ(read_trajectory("/proc/self/mem").error().code, ErrorCode::kIo);
  const TemporaryFolder folder;
  const auto file = folder.path() / "poses.txt";
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(read_trajectory(file).error().code, ErrorCode::kUnreadable);
  std::filesystem::remove(file);
  write_text(file, "1 0 0 0 0 0 0 1\n");
  const std::atomic<bool> cancel{true};
  EXPECT_EQ(read_trajectory(file, &cancel).error().code, ErrorCode::kCancelled);
  std::filesystem::resize_file(file, 20'000'000'000U);
  EXPECT_THAT(read_trajectory(file).error().message,
              HasSubstr("has 20000000000 bytes: must have at most 268435456"));
}

TEST(TrajectoryIo, ReadsTumWithQuaternionOrderXyzw) {
  const TrajectoryFile file = read_ok(
      "# timestamp tx ty tz qx qy qz qw\n"
      "# init_scene_depth 2.5\n"
      "\n"
      "1.5 1 2 3 0 0 0.70710678118654752 0.70710678118654752\r\n"
      "2.25\t-1 -2 -3 1 0 0 0\n");
  EXPECT_EQ(file.format, TrajectoryFormat::kTum);
  EXPECT_TRUE(file.has_times);
  EXPECT_EQ(file.comments.at("init_scene_depth"), "2.5");
  ASSERT_EQ(file.trajectory.size(), 2U);
  const StampedPose& first = file.trajectory.poses()[0];
  EXPECT_EQ(first.t_ns, 1'500'000'000);
  // A quarter turn about z takes x to y.
  EXPECT_TRUE((first.pose.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_EQ(first.pose.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(file.trajectory.poses()[1].t_ns, 2'250'000'000);
}

TEST(TrajectoryIo, TakesTumRowsOfNanForGaps) {
  // As groundtruthSync.txt of TUM monoVO.
  const TrajectoryFile file = read_ok(
      "10 0 0 0 0 0 0 1\n"
      "10.1 1 0 0 0 0 0 1\n"
      "10.2 nan nan nan nan nan nan nan\n"
      "10.3 NaN NaN NaN NaN NaN NaN NaN\n"
      "10.4 5 0 0 0 0 0 1\n");
  EXPECT_EQ(file.trajectory.size(), 3U);
  EXPECT_EQ(file.unknown_poses, 2U);
  EXPECT_TRUE(file.trajectory.at(10'050'000'000));
  EXPECT_FALSE(file.trajectory.at(10'250'000'000));
  EXPECT_THAT(error_of("10 0 nan 0 0 0 0 1\n").message, HasSubstr(":1: column 3"));
  EXPECT_THAT(error_of("10 nan nan nan nan nan nan nan\n").message, HasSubstr("contains no poses"));
}

TEST(TrajectoryIo, KeepsEveryNanosecondOfUnixTimes) {
  const TrajectoryFile file = read_ok(
      "1403636579.763555584 0 0 0 0 0 0 1\n"
      "1.403636579763555585e+09 0 0 0 0 0 0 1\n"
      "14036365797635555.86e-7 0 0 0 0 0 0 1\n");
  EXPECT_EQ(file.trajectory.poses()[0].t_ns, 1'403'636'579'763'555'584);
  EXPECT_EQ(file.trajectory.poses()[1].t_ns, 1'403'636'579'763'555'585);
  EXPECT_EQ(file.trajectory.poses()[2].t_ns, 1'403'636'579'763'555'586);
}

TEST(TrajectoryIo, RoundsTimesToTheNearestNanosecond) {
  const TrajectoryFile file = read_ok(
      "-0.0000000015 0 0 0 0 0 0 1\n"
      "0.0000000004999 0 0 0 0 0 0 1\n"
      "0.0000000005 0 0 0 0 0 0 1\n"
      "3 0 0 0 0 0 0 1\n");
  EXPECT_EQ(file.trajectory.poses()[0].t_ns, -2);
  EXPECT_EQ(file.trajectory.poses()[1].t_ns, 0);
  EXPECT_EQ(file.trajectory.poses()[2].t_ns, 1);
  EXPECT_EQ(file.trajectory.poses()[3].t_ns, 3'000'000'000);
}

TEST(TrajectoryIo, ReadsEurocWithQuaternionOrderWxyz) {
  const TrajectoryFile file = read_ok(
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1]\n"
      "1403636580838555648,4.688319,-1.786938,0.783338,0.0,1.0,0.0,0.0,-0.02\n"
      "1403636580843555328, 4.688177, -1.786770, 0.787350, 1.0, 0.0, 0.0, 0.0, -0.03\n");
  EXPECT_EQ(file.format, TrajectoryFormat::kEuroc);
  ASSERT_EQ(file.trajectory.size(), 2U);
  const StampedPose& first = file.trajectory.poses()[0];
  EXPECT_EQ(first.t_ns, 1'403'636'580'838'555'648);
  EXPECT_EQ(first.pose.rotation.x(), 1.0);
  EXPECT_EQ(first.pose.translation, Eigen::Vector3d(4.688319, -1.786938, 0.783338));
  EXPECT_EQ(file.trajectory.poses()[1].pose.rotation.w(), 1.0);
}

constexpr const char* kKittiText =
    "1 0 0 10 0 1 0 20 0 0 1 30\n"
    "0 -1 0 11 1 0 0 21 0 0 1 31\n"
    "1.000000e+00 0 0 12 0 1 0 22 0 0 1 32\n";

TEST(TrajectoryIo, ReadsKittiByLineWhereThereAreNoTimes) {
  const TrajectoryFile file = read_ok(kKittiText);
  EXPECT_EQ(file.format, TrajectoryFormat::kKitti);
  EXPECT_FALSE(file.has_times);
  ASSERT_EQ(file.trajectory.size(), 3U);
  EXPECT_EQ(file.trajectory.poses()[2].t_ns, 2'000'000'000);
  const Pose& second = file.trajectory.poses()[1].pose;
  EXPECT_EQ(second.translation, Eigen::Vector3d(11, 21, 31));
  EXPECT_TRUE((second.rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
}

TEST(TrajectoryIo, TakesKittiTimesOnlyWhereTheyAreAsManyAsThePoses) {
  const TemporaryFolder folder;
  write_text(folder.path() / "00.txt", kKittiText);
  write_text(folder.path() / "times.txt", "0.0\n1.037140e-01\n2.074340e-01\n");
  const Result<TrajectoryFile> timed = read_trajectory(folder.path() / "00.txt");
  ASSERT_TRUE(timed.ok()) << timed.error().message;
  EXPECT_TRUE(timed->has_times);
  EXPECT_EQ(timed->trajectory.poses()[1].t_ns, 103'714'000);

  write_text(folder.path() / "times.txt", "0.0\n0.1\n");
  const Result<TrajectoryFile> untimed = read_trajectory(folder.path() / "00.txt");
  ASSERT_TRUE(untimed.ok());
  EXPECT_FALSE(untimed->has_times);
}

TEST(TrajectoryIo, NamesFileLineColumnAndValueOfABadNumber) {
  const Error error = error_of("0 0 0 0 0 0 0 1\n1 0 1,5 0 0 0 0 1\n");
  EXPECT_EQ(error.code, ErrorCode::kUnreadable);
  EXPECT_THAT(error_of("0 0 0 0 0 0 0 1\n1 0 1.5.2 0 0 0 0 1\n").message,
              AllOf(HasSubstr("poses.txt:2:"), HasSubstr("column 3"), HasSubstr("'1.5.2'")));
  EXPECT_THAT(error_of("0 0 0 0 0 0 nan 1\n").message, HasSubstr("column 7 = 'nan'"));
  EXPECT_THAT(error_of("0 0 0 0 0 0 1e999 1\n").message, HasSubstr("column 7 = '1e999'"));
  EXPECT_THAT(error_of("soon 0 0 0 0 0 0 1\n").message, HasSubstr("column 1 = 'soon'"));
  EXPECT_THAT(error_of("1e12 0 0 0 0 0 0 1\n").message, HasSubstr("column 1 = '1e12'"));
  EXPECT_THAT(error_of("1.5,0,0,0,1,0,0,0\n").message,
              AllOf(HasSubstr("column 1 = '1.5'"), HasSubstr("nanoseconds")));
}

TEST(TrajectoryIo, RefusesWhatIsNoTrajectory) {
  EXPECT_EQ(read_trajectory("/nonexistent/poses.txt").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(read_trajectory(std::filesystem::temp_directory_path()).error().code,
            ErrorCode::kUnreadable);
  EXPECT_THAT(error_of("").message, HasSubstr("contains no poses"));
  EXPECT_THAT(error_of("# only a comment\n\n").message, HasSubstr("contains no poses"));
  EXPECT_THAT(error_of("0 0 0 0 0 0 0 1\n1 0 0 0\n").message,
              HasSubstr("poses.txt:2: 4 columns: must be 8"));
  EXPECT_THAT(error_of("1,2,3\n").message, HasSubstr("3 columns: must be 8 or more"));
  EXPECT_THAT(error_of("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0\n").message,
              HasSubstr("poses.txt:2: 3 columns: must be 12"));
}

TEST(TrajectoryIo, RefusesRotationsThatAreNone) {
  EXPECT_THAT(error_of("0 0 0 0 0 0 0 0\n").message, HasSubstr("quaternion's norm"));
  EXPECT_THAT(error_of("0 0 0 0 0 0 0 1.2\n").message, HasSubstr("quaternion's norm is 1.2"));
  EXPECT_THAT(error_of("2 0 0 0 0 1 0 0 0 0 1 0\n").message, HasSubstr("not a rotation matrix"));
  EXPECT_THAT(error_of("-1 0 0 0 0 1 0 0 0 0 1 0\n").message, HasSubstr("not a rotation matrix"));
}

std::vector<double> x_of(const Trajectory& trajectory) {
  std::vector<double> values;
  for (const StampedPose& stamped : trajectory.poses()) {
    values.push_back(stamped.pose.translation.x());
  }
  return values;
}

/// As the truth of TUM's freiburg2_desk, where two lines have one stamp.
TEST(TrajectoryIo, KeepsTheFirstOfPosesWithTheSameTime) {
  const TrajectoryFile file = read_ok(
      "1311868164.4 1 0 0 0 0 0 1\n"
      "1311868164.5 2 0 0 0 0 0 1\n"
      "1311868164.5 3 0 0 0 0 0 1\n"
      "1311868164.6 4 0 0 0 0 0 1\n"
      "1311868164.6 5 0 0 0 0 0 1\n"
      "1311868164.60 6 0 0 0 0 0 1\n");
  EXPECT_THAT(x_of(file.trajectory), ElementsAre(1, 2, 4));
  ASSERT_EQ(file.warnings.size(), 1U);
  EXPECT_THAT(file.warnings[0],
              AllOf(HasSubstr("poses.txt: 3 poses (first in line 3)"), HasSubstr("ignored")));
  EXPECT_FALSE(file.as_listed());
}

TEST(TrajectoryIo, SortsPosesByTime) {
  const TrajectoryFile file = read_ok(
      "# a comment\n"
      "3 30 0 0 0 0 0 1\n"
      "1 10 0 0 0 0 0 1\n"
      "2 20 0 0 0 0 0 1\n"
      "4 40 0 0 0 0 0 1\n"
      "2 21 0 0 0 0 0 1\n");
  EXPECT_THAT(x_of(file.trajectory), ElementsAre(10, 20, 30, 40));
  EXPECT_THAT(file.warnings,
              ElementsAre(HasSubstr("1 poses (first in line 6) repeat the time"),
                          HasSubstr("3 poses (first in line 3) are out of time order: sorted")));
  EXPECT_TRUE(read_ok("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n").warnings.empty());
}

TEST(TrajectoryIo, PutsGapsWhereTheirTimesAre) {
  const TrajectoryFile file = read_ok(
      "3 30 0 0 0 0 0 1\n"
      "1 10 0 0 0 0 0 1\n"
      "2 nan nan nan nan nan nan nan\n"
      "4 40 0 0 0 0 0 1\n");
  EXPECT_THAT(x_of(file.trajectory), ElementsAre(10, 30, 40));
  EXPECT_FALSE(file.trajectory.at(1'500'000'000));
  EXPECT_TRUE(file.trajectory.at(3'500'000'000));
}

TEST(TrajectoryIo, OrdersEurocRowsAndKittiTimesToo) {
  const TrajectoryFile euroc = read_ok(
      "200,2,0,0,1,0,0,0\n"
      "100,1,0,0,1,0,0,0\n"
      "200,3,0,0,1,0,0,0\n");
  EXPECT_THAT(x_of(euroc.trajectory), ElementsAre(1, 2));
  EXPECT_EQ(euroc.warnings.size(), 2U);

  const TemporaryFolder folder;
  write_text(folder.path() / "00.txt", kKittiText);
  write_text(folder.path() / "times.txt", "0.0\n0.2\n0.1\n");
  const Result<TrajectoryFile> kitti = read_trajectory(folder.path() / "00.txt");
  ASSERT_TRUE(kitti.ok()) << kitti.error().message;
  EXPECT_THAT(x_of(kitti->trajectory), ElementsAre(10, 12, 11));
  EXPECT_THAT(kitti->warnings, ElementsAre(HasSubstr("times.txt: 1 poses (first in line 3)")));
}

Trajectory random_trajectory() {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Trajectory trajectory;
  std::int64_t t_ns = -3'000'000'001;
  for (int i = 0; i < 500; ++i) {
    t_ns += 1 + static_cast<std::int64_t>(random() % 1'000'000'007U);
    StampedPose stamped;
    stamped.t_ns = t_ns;
    stamped.pose.rotation =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random));
    stamped.pose.translation = {1e6 * normal(random), normal(random), 1e-7 * normal(random)};
    EXPECT_TRUE(trajectory.append(stamped).ok());
  }
  return trajectory;
}

TEST(TrajectoryIo, WritesTumThatReadsBackExactly) {
  const TemporaryFolder folder;
  const Trajectory written = random_trajectory();
  ASSERT_TRUE(write_tum(folder.path() / "a.tum", written, {{"init_scene_depth", "0.98"}}).ok());
  const Result<TrajectoryFile> file = read_trajectory(folder.path() / "a.tum");
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->comments.at("init_scene_depth"), "0.98");
  ASSERT_EQ(file->trajectory.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    const StampedPose& a = written.poses()[i];
    const StampedPose& b = file->trajectory.poses()[i];
    EXPECT_EQ(a.t_ns, b.t_ns);
    EXPECT_EQ(a.pose.translation, b.pose.translation);
    EXPECT_EQ(a.pose.rotation.coeffs(), b.pose.rotation.coeffs());
  }
  ASSERT_TRUE(write_tum(folder.path() / "b.tum", file->trajectory, file->comments).ok());
  EXPECT_EQ(read_text(folder.path() / "a.tum"), read_text(folder.path() / "b.tum"));
}

TEST(TrajectoryIo, LeavesNothingBehindWhenItCannotWrite) {
  const TemporaryFolder folder;
  const Status missing = write_tum(folder.path() / "absent" / "a.tum", random_trajectory());
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::kIo);
  // The target is a folder that holds something: it cannot be replaced.
  std::filesystem::create_directories(folder.path() / "taken" / "inside");
  EXPECT_FALSE(write_tum(folder.path() / "taken", random_trajectory()).ok());
  EXPECT_FALSE(write_tum(folder.path() / "a.tum", {}, {{"two words", "1"}}).ok());
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    ++entries;
  }
  EXPECT_EQ(entries, 1U);
}

}  // namespace
}  // namespace overfly
