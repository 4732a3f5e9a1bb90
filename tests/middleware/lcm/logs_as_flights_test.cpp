// Event logs that LCM's own library writes, read as flight logs.
#include <gmock/gmock.h>

#include <overfly_lcm/airspeed_t.hpp>
#include <overfly_lcm/barometer_t.hpp>
#include <overfly_lcm/debug_t.hpp>
#include <overfly_lcm/gps_t.hpp>
#include <overfly_lcm/image_t.hpp>
#include <overfly_lcm/imu_t.hpp>
#include <overfly_lcm/magnetometer_t.hpp>
#include <overfly_lcm/pose_t.hpp>
#include <overfly_lcm/range_t.hpp>
#include <overfly_lcm/sim_time_t.hpp>
#include <overfly_lcm/truth_t.hpp>
#include <overfly_lcm/world_pose_t.hpp>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/lcm/lcm_messages.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "middleware/lcm/log_writer.hpp"
#include "tests/support/support.hpp"

namespace overfly::lcm {
namespace {

namespace logs = flight::logs;

TEST(LogsAsFlights, KnowTheFingerprintsOfTheTypes) {
  const auto of = [](logs::LcmType type) { return static_cast<std::int64_t>(type); };
  EXPECT_EQ(overfly_lcm::truth_t::getHash(), of(logs::LcmType::kTruth));
  EXPECT_EQ(overfly_lcm::image_t::getHash(), of(logs::LcmType::kImage));
  EXPECT_EQ(overfly_lcm::pose_t::getHash(), of(logs::LcmType::kPose));
  EXPECT_EQ(overfly_lcm::sim_time_t::getHash(), of(logs::LcmType::kSimTime));
  EXPECT_EQ(overfly_lcm::debug_t::getHash(), of(logs::LcmType::kDebug));
  EXPECT_EQ(overfly_lcm::world_pose_t::getHash(), of(logs::LcmType::kWorldPose));
  EXPECT_EQ(overfly_lcm::imu_t::getHash(), of(logs::LcmType::kImu));
  EXPECT_EQ(overfly_lcm::barometer_t::getHash(), of(logs::LcmType::kBarometer));
  EXPECT_EQ(overfly_lcm::gps_t::getHash(), of(logs::LcmType::kGps));
  EXPECT_EQ(overfly_lcm::airspeed_t::getHash(), of(logs::LcmType::kAirspeed));
  EXPECT_EQ(overfly_lcm::magnetometer_t::getHash(), of(logs::LcmType::kMagnetometer));
  EXPECT_EQ(overfly_lcm::range_t::getHash(), of(logs::LcmType::kRange));
}

TEST(LogsAsFlights, HaveThePosesOfTheWriter) {
  constexpr std::int64_t kEpochNs = 1'700'000'000'000'000'000;
  const overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.lcm";
  const Eigen::Quaterniond R_enu_body = R_world_body_from({0.3, -0.1, 2.0});
  {
    const auto writer = LogWriter::create(file, kEpochNs).value();
    ASSERT_TRUE(writer->write_calibration("C_", "belly", {}, 0).ok());
    for (int i = 0; i < 40; ++i) {
      const std::int64_t t_ns = i * kNsPerS / 31;
      const Image image(640, 480, 1, 9);
      ASSERT_TRUE(writer->write_image("C_", {i, t_ns, 5'000, image}).ok());
      const Pose T_world_camera{R_enu_body * R_body_camera_nadir(), {3.0, 2.0 * i, 300.0}};
      ASSERT_TRUE(writer->write_truth("C_", {i, t_ns, t_ns, T_world_camera}).ok());
    }
    ASSERT_TRUE(writer->finish().ok());
  }
  const auto log = logs::open_log(file);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_THAT(log->warnings, ::testing::IsEmpty());
  ASSERT_EQ(log->streams.size(), 4U);
  EXPECT_EQ(log->streams[1].description.name, "C_IMAGE");
  EXPECT_EQ(log->streams[1].messages, 40U);
  EXPECT_EQ(log->streams[1].last_ns, 39 * kNsPerS / 31);
  const auto trajectory = logs::read_log_trajectory(*log, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_EQ(trajectory->poses.size(), 40U);
  EXPECT_EQ(trajectory->position_source, "C_TRUTH");
  for (int i = 0; i < 40; ++i) {
    const logs::LogPose& pose = trajectory->poses[static_cast<std::size_t>(i)];
    EXPECT_EQ(pose.t_ns, i * kNsPerS / 31);
    EXPECT_EQ(pose.position, Eigen::Vector3d(2.0 * i, 3.0, -300.0));
    const Eigen::Quaterniond expected = Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()) *
                                        Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitY()) *
                                        Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
    EXPECT_LT(rotation_angle_rad(pose.R_ned_body, expected), 1e-6);
  }
}

}  // namespace
}  // namespace overfly::lcm
