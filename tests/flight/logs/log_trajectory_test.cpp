#include "flight/logs/truth/log_trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/pose.hpp"
#include "core/motion/trajectory_io.hpp"
#include "core/time.hpp"
#include "flight/flight.hpp"
#include "flight/logs/boot_clock.hpp"
#include "flight/logs/local_grid.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

using ::testing::HasSubstr;

/// To the north at 25 m/s, climbing, with a bank of 20 deg.
LogTrajectory climb() {
  LogTrajectory trajectory;
  trajectory.georeferenced = true;
  trajectory.position_source = "SIM";
  trajectory.attitude_source = "SIM";
  for (int i = 0; i < 10; ++i) {
    trajectory.poses.push_back({kNsPerS + i * kNsPerS / 10,
                                {47.0 + 2.5 * i / 111200.0, 8.0, 500.0 + i},
                                R_ned_body_from({rad_from_deg(20), rad_from_deg(5), 0.1})});
  }
  return trajectory;
}

TEST(NedAttitude, AgreesWithTheAttitudesOfCore) {
  const RollPitchYaw angles{0.3, -0.2, 2.5};
  EXPECT_LT(rotation_angle_rad(R_enu_ned() * R_ned_body_from(angles), R_world_body_from(angles)),
            1e-12);
}

TEST(LogTrajectoryFiles, TumIsInTheWorldFrameOfTheFirstPose) {
  const overfly::testing::TemporaryFolder folder;
  ASSERT_TRUE(write_log_tum(folder.path() / "a.tum", climb()).ok());
  const auto read = read_trajectory(folder.path() / "a.tum");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->comments.at("origin_lat_deg"), "47");
  EXPECT_EQ(read->comments.at("origin_alt_msl_m"), "500");
  EXPECT_EQ(read->comments.at("position_source"), "SIM");
  const auto& poses = read->trajectory.poses();
  ASSERT_EQ(poses.size(), 10U);
  EXPECT_EQ(poses[0].t_ns, kNsPerS);
  EXPECT_LT(poses[0].pose.translation.norm(), 1e-9);
  EXPECT_NEAR(poses[9].pose.translation.z(), 9.0, 1e-3);
  EXPECT_NEAR(poses[9].pose.translation.y(), 22.5, 0.02);
  const RollPitchYaw angles = attitude_from(poses[0].pose.rotation);
  EXPECT_NEAR(angles.roll_rad, rad_from_deg(20), 1e-9);
  EXPECT_NEAR(angles.pitch_rad, rad_from_deg(5), 1e-9);
  EXPECT_NEAR(angles.yaw_rad, 0.1, 1e-9);
}

TEST(LogTrajectoryFiles, CsvWithTheGeoidCanBeFlown) {
  const overfly::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.csv";
  ASSERT_TRUE(write_log_csv(file, climb()).ok());
  EXPECT_THAT(
      overfly::testing::read_text(file),
      HasSubstr("t_s,lat_deg,lon_deg,alt_msl_m,roll_deg,pitch_deg,yaw_deg\n1.000000000,47,8,500,"));
  ASSERT_TRUE(write_log_csv(file, climb(), 48.0).ok());
  const LocalFrame frame(geodetic_from_deg(47.0, 8.0, 548.0));
  const auto flight = fly_log(file, frame);
  ASSERT_TRUE(flight.ok()) << flight.error().message;
  const auto state = (*flight)->state_at(0);
  ASSERT_TRUE(state.ok() && *state);
  EXPECT_LT((*state)->T_world_body.translation.norm(), 1e-6);
  EXPECT_NEAR((*state)->v_body_world_m_s.y(), 25.0, 0.1);
  EXPECT_NEAR(attitude_from((*state)->T_world_body.rotation).roll_rad, rad_from_deg(20), 1e-6);
}

TEST(LogTrajectoryFiles, AreWrittenCompletelyOrNotAtAll) {
  const Status status = write_log_tum("/nonexistent/a.tum", climb());
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_THAT(status.error().message, HasSubstr("/nonexistent/a.tum: cannot be written"));
}

TEST(LocalGrid, InvertsArduPilotsMetres) {
  // ArduPilot's get_distance_NE: the latitude step times 0.011131884502145034 m, the longitude step
  // times that and the cosine of the mean latitude.
  const LocalOrigin origin{-35.3632620, 149.1652370, 584.09, LocalGrid::kArduPilot};
  const Eigen::Vector3d ned_m(1200.0, -3400.0, -300.0);
  const Eigen::Vector3d point = geodetic_from_local(origin, ned_m);
  const double per_deg = 0.011131884502145034 * 1e7;
  EXPECT_NEAR((point.x() - origin.lat_deg) * per_deg, 1200.0, 1e-6);
  EXPECT_NEAR((point.y() - origin.lon_deg) * per_deg *
                  std::cos(rad_from_deg((point.x() + origin.lat_deg) / 2.0)),
              -3400.0,
              1e-6);
  EXPECT_DOUBLE_EQ(point.z(), 884.09);
}

TEST(LocalGrid, InvertsPx4sProjection) {
  // Forward azimuthal equidistant projection (Snyder 1987, eq. 22-4, 22-5, 25-2).
  const LocalOrigin origin{47.397742, 8.545594, 488.0, LocalGrid::kPx4};
  const Eigen::Vector3d point = geodetic_from_local(origin, {5000.0, -8000.0, 10.0});
  const double lat = rad_from_deg(point.x());
  const double lat0 = rad_from_deg(origin.lat_deg);
  const double step = rad_from_deg(point.y() - origin.lon_deg);
  const double c =
      std::acos(std::sin(lat0) * std::sin(lat) + std::cos(lat0) * std::cos(lat) * std::cos(step));
  const double k = c / std::sin(c) * 6371000.0;
  EXPECT_NEAR(
      k * (std::cos(lat0) * std::sin(lat) - std::sin(lat0) * std::cos(lat) * std::cos(step)),
      5000.0,
      1e-3);
  EXPECT_NEAR(k * std::cos(lat) * std::sin(step), -8000.0, 1e-3);
}

TEST(LocalGrid, FindsTheOriginOfAPoint) {
  for (const LocalGrid grid : {LocalGrid::kArduPilot, LocalGrid::kPx4}) {
    const LocalOrigin origin{47.0, 179.999, 400.0, grid};
    const Eigen::Vector3d ned_m(3000.0, 5000.0, -120.0);
    const LocalOrigin found = origin_of_local(grid, geodetic_from_local(origin, ned_m), ned_m);
    EXPECT_NEAR(found.lat_deg, 47.0, 1e-12);
    EXPECT_NEAR(std::remainder(found.lon_deg - 179.999, 360.0), 0.0, 1e-12);
    EXPECT_NEAR(found.alt_msl_m, 400.0, 1e-12);
  }
}

TEST(BootClock, BelievesThreeStampsThatAgree) {
  BootClock clock;
  const auto seconds = [](double t_s) { return static_cast<std::int64_t>(t_s * 1e9); };
  EXPECT_EQ(clock.take(seconds(100.0)), (LogTime{0, seconds(100.0)}));
  EXPECT_EQ(clock.take(seconds(99.0)), (LogTime{0, seconds(99.0)}));
  EXPECT_EQ(clock.take(seconds(97.5)), std::nullopt);  // more than 2 s before the latest
  EXPECT_EQ(clock.take(seconds(100.1)), (LogTime{0, seconds(100.1)}));
  EXPECT_EQ(clock.take(seconds(3.0)), std::nullopt);
  EXPECT_EQ(clock.take(seconds(3.1)), std::nullopt);
  EXPECT_EQ(clock.take(seconds(3.2)), (LogTime{1, seconds(3.2)}));
  for (int i = 0; i < 2; ++i) EXPECT_EQ(clock.take(seconds(5000.0 + i)), std::nullopt);
  EXPECT_EQ(clock.take(seconds(5002.0)), (LogTime{1, seconds(5002.0)}));  // a gap, no restart
  EXPECT_EQ(clock.take(-1), std::nullopt);
  EXPECT_EQ(clock.take(std::numeric_limits<std::int64_t>::max()), std::nullopt);
  EXPECT_EQ(clock.implausible(), 7U);
}

TEST(BootClock, TakesBackFirstStampsThatAreHeld) {
  BootClock clock;
  EXPECT_FALSE(clock.proven());
  EXPECT_EQ(clock.take(5000 * kNsPerS), (LogTime{0, 5000 * kNsPerS}));
  EXPECT_EQ(clock.take(5001 * kNsPerS), (LogTime{0, 5001 * kNsPerS}));
  EXPECT_EQ(clock.take(1 * kNsPerS), std::nullopt);
  EXPECT_EQ(clock.take(2 * kNsPerS), std::nullopt);
  EXPECT_FALSE(clock.proven());
  EXPECT_EQ(clock.take(3 * kNsPerS), (LogTime{0, 3 * kNsPerS}));  // no restart
  EXPECT_TRUE(clock.proven() && clock.first_were_wrong());
  EXPECT_EQ(clock.implausible(), 4U);
  for (int i = 0; i < 3; ++i) (void)clock.take((9000 + i) * kNsPerS);
  for (int i = 0; i < 3; ++i) (void)clock.take(i * kNsPerS);
  EXPECT_EQ(clock.latest(), (LogTime{1, 2 * kNsPerS}));  // proven: this one is
}

TEST(BootClock, TakesBackAJumpThatNothingFollows) {
  BootClock clock;
  for (int i = 0; i < 5; ++i) (void)clock.take((100 + i) * kNsPerS);
  ASSERT_TRUE(clock.proven());
  const LogTime jumped{0, 400 * kNsPerS};
  EXPECT_EQ(clock.take(400 * kNsPerS), jumped);
  EXPECT_FALSE(clock.proven());
  EXPECT_EQ(clock.take(105 * kNsPerS), std::nullopt);
  EXPECT_EQ(clock.take(106 * kNsPerS), std::nullopt);
  EXPECT_EQ(clock.take(107 * kNsPerS), (LogTime{0, 107 * kNsPerS}));  // no restart
  EXPECT_TRUE(clock.proven() && clock.was_wrong(jumped));
  EXPECT_FALSE(clock.first_were_wrong() || clock.was_wrong({0, 104 * kNsPerS}));
  EXPECT_EQ(clock.implausible(), 3U);
  // A gap: two more follow.
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(clock.take((400 + i) * kNsPerS));
  EXPECT_TRUE(clock.proven());
  EXPECT_FALSE(clock.was_wrong(jumped));
  // A damaged stamp, and the vehicle starts again.
  EXPECT_EQ(clock.take(500 * kNsPerS), (LogTime{0, 500 * kNsPerS}));
  for (int i = 0; i < 3; ++i) (void)clock.take(i * kNsPerS);
  EXPECT_EQ(clock.latest(), (LogTime{1, 2 * kNsPerS}));
  EXPECT_TRUE(clock.was_wrong({0, 500 * kNsPerS}));
}

/// Messages are not held for ever where each comes late.
TEST(BootClock, IsProvenBetweenStampsThatAreFarApart) {
  BootClock clock;
  int proven = 0;
  for (int i = 0; i < 30; ++i) {
    EXPECT_TRUE(clock.take((20 * i + i % 2) * kNsPerS));
    if (clock.proven()) ++proven;
  }
  EXPECT_GE(proven, 26) << "once it is known how far apart its stamps are";
  EXPECT_EQ(clock.implausible(), 0U);
}

}  // namespace
}  // namespace overfly::flight::logs
