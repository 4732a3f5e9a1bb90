#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/motion/trajectory_io.hpp"
#include "core/time.hpp"
#include "flight/flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight {
namespace {

using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kHeader = "t_s,lat_deg,lon_deg,alt_ellipsoid_m,roll_deg,pitch_deg,yaw_deg\n";

LocalFrame frame() { return LocalFrame(geodetic_from_deg(44.0, -123.0, 100.0)); }

Error error_of(const std::string& text) {
  const TemporaryFolder folder;
  write_text(folder.path() / "log.csv", text);
  const auto flight = fly_log(folder.path() / "log.csv", frame());
  EXPECT_FALSE(flight.ok());
  return flight.ok() ? Error{} : flight.error();
}

std::unique_ptr<TruthSource> fly_text(const std::string& text, bool camera_poses = false) {
  const TemporaryFolder folder;
  write_text(folder.path() / "log", text);
  auto flight = fly_log(folder.path() / "log", frame(), camera_poses);
  EXPECT_TRUE(flight.ok()) << (flight.ok() ? "" : flight.error().message);
  return flight.ok() ? std::move(flight).value() : nullptr;
}

TEST(LogFlight, ReadsGeodeticPositionsAndAttitudesOfTheLocalHorizon) {
  // 0.001 deg of latitude at 44 deg north is 111.11 m (WGS84 meridian radius 6,366,270 m there).
  const auto flight = fly_text(std::string(kHeader) +
                               "100.0,44.0,-123.0,400.0,0,0,90\n"
                               "104.0,44.001,-123.0,400.0,20,5,90\n");
  EXPECT_EQ(flight->duration_ns(), 4 * kNsPerS);
  EXPECT_EQ(flight->description(), "log: log");
  const AircraftState begin = flight->state_at(0).value().value();
  EXPECT_LT((begin.T_world_body.translation - Eigen::Vector3d(0, 0, 300)).norm(), 1e-6);
  const Eigen::Vector3d nose = begin.T_world_body.rotation * Eigen::Vector3d::UnitX();
  EXPECT_LT((nose - Eigen::Vector3d::UnitX()).norm(), 1e-9);  // yaw 90 deg = east
  const AircraftState end = flight->state_at(4 * kNsPerS).value().value();
  EXPECT_NEAR(end.T_world_body.translation.y(), 111.1, 0.1);
  EXPECT_NEAR(begin.v_body_world_m_s.y(), 111.1 / 4.0, 0.03);
  const RollPitchYaw attitude = attitude_from(end.T_world_body.rotation);
  // World and local horizon differ by 0.001 deg here.
  EXPECT_NEAR(deg_from_rad(attitude.roll_rad), 20.0, 0.002);
  EXPECT_NEAR(deg_from_rad(attitude.pitch_rad), 5.0, 0.002);
  EXPECT_NEAR(deg_from_rad(attitude.yaw_rad), 90.0, 0.002);
}

/// 10 km from the origin the horizon has tilted by 0.09 deg; level there is not level in `world`.
TEST(LogFlight, AttitudesAreRelativeToTheHorizonOfTheirPlace) {
  const auto flight = fly_text(std::string(kHeader) +
                               "0,44.09,-123.0,400.0,0,0,0\n"
                               "1,44.0902,-123.0,400.0,0,0,0\n");
  const AircraftState state = flight->state_at(0).value().value();
  const Eigen::Vector3d nose = state.T_world_body.rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::asin(nose.z()), -rad_from_deg(0.09), rad_from_deg(0.0005));
}

TEST(LogFlight, FliesTumPosesOfTheBodyAsTheyAre) {
  const auto flight = fly_text(
      "10.5 1 2 3 0 0 0 1\n"
      "11.5 2 2 3 0 0 0 1\n"
      "12.0 2.5 2 3 0 0 0.70710678118654752 0.70710678118654752\n");
  EXPECT_EQ(flight->duration_ns(), 1'500'000'000);
  EXPECT_EQ(flight->state_at(0)->value().T_world_body.translation, Eigen::Vector3d(1, 2, 3));
  const AircraftState middle = flight->state_at(500'000'000).value().value();
  EXPECT_NEAR(middle.T_world_body.translation.x(), 1.5, 1e-12);
  EXPECT_NEAR(middle.v_body_world_m_s.x(), 1.0, 1e-12);
  // A quarter turn in half a second about z, expressed in the body.
  const AircraftState turning = flight->state_at(1'250'000'000).value().value();
  EXPECT_TRUE(turning.omega_body_rad_s.isApprox(Eigen::Vector3d(0, 0, kPi), 1e-9));
  EXPECT_NEAR(rotation_angle_rad(turning.T_world_body.rotation, Eigen::Quaterniond::Identity()),
              kPi / 4,
              1e-9);
}

TEST(LogFlight, TakesTheNadirMountOffCameraPoses) {
  const TemporaryFolder folder;
  const Pose T_world_body{R_world_body_from({0.3, 0.1, -1.0}), {10, 20, 300}};
  const Pose T_world_camera = T_world_body * Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  Trajectory camera;
  ASSERT_TRUE(camera.append({0, T_world_camera}).ok());
  ASSERT_TRUE(camera.append({kNsPerS, T_world_camera}).ok());
  ASSERT_TRUE(write_tum(folder.path() / "camera.tum", camera).ok());
  const auto flight = fly_log(folder.path() / "camera.tum", frame(), true);
  ASSERT_TRUE(flight.ok());
  const Pose flown = (*flight)->state_at(kNsPerS / 2)->value().T_world_body;
  EXPECT_LT((flown.translation - T_world_body.translation).norm(), 1e-12);
  EXPECT_LT(rotation_angle_rad(flown.rotation, T_world_body.rotation), 1e-12);
}

/// A circle sampled at 10 Hz. A parabola's derivative is off by R w^3 dt^2 / 3 = 13 mm/s at the
/// flight's ends and half of that inside; cubic Hermite makes at most 4/27 * dt of each in
/// position: 0.19 mm + 0.09 mm.
TEST(LogFlight, PositionsRunSmoothlyThroughThePoses) {
  Trajectory circle;
  const double radius_m = 60.0;
  const double rate_rad_s = 0.4;
  const auto at = [&](double t_s) {
    return Eigen::Vector3d(
        radius_m * std::sin(rate_rad_s * t_s), radius_m * std::cos(rate_rad_s * t_s), 300.0);
  };
  for (int i = 0; i <= 100; ++i) {
    ASSERT_TRUE(
        circle.append({i * 100'000'000LL, {Eigen::Quaterniond::Identity(), at(0.1 * i)}}).ok());
  }
  const TemporaryFolder folder;
  ASSERT_TRUE(write_tum(folder.path() / "circle.tum", circle).ok());
  const auto flight = fly_log(folder.path() / "circle.tum", frame()).value();
  for (std::int64_t t_ns = 0; t_ns <= 10 * kNsPerS; t_ns += 3'333'333) {
    const AircraftState state = flight->state_at(t_ns).value().value();
    ASSERT_LT((state.T_world_body.translation - at(s_from_ns(t_ns))).norm(), 3e-4) << t_ns;
    ASSERT_NEAR(state.airspeed_m_s, radius_m * rate_rad_s, 0.02);
  }
  const AircraftState before = flight->state_at(5 * kNsPerS - 1).value().value();
  const AircraftState after = flight->state_at(5 * kNsPerS + 1).value().value();
  EXPECT_LT((before.v_body_world_m_s - after.v_body_world_m_s).norm(), 1e-6);
}

TEST(LogFlight, KnowsNothingOutsideItsTimes) {
  const auto flight = fly_text("5 0 0 0 0 0 0 1\n6 1 0 0 0 0 0 1\n");
  EXPECT_EQ(flight->state_at(-1).error().code, ErrorCode::kInvalidArgument);
  EXPECT_TRUE(flight->state_at(kNsPerS).value().has_value());
  EXPECT_FALSE(flight->state_at(kNsPerS + 1).value().has_value());
}

TEST(LogFlight, OrdersRowsByTimeAndSaysSo) {
  const TemporaryFolder folder;
  write_text(folder.path() / "log.csv",
             std::string(kHeader) +
                 "2,44,-123,402,0,0,0\n0,44,-123,400,0,0,0\n1,44,-123,401,0,0,0\n"
                 "1,44,-123,999,0,0,0\n");
  const auto flight = fly_log(folder.path() / "log.csv", frame());
  ASSERT_TRUE(flight.ok()) << flight.error().message;
  EXPECT_EQ((*flight)->duration_ns(), 2 * kNsPerS);
  const LocalFrame local = frame();
  const AircraftState middle = (*flight)->state_at(kNsPerS).value().value();
  EXPECT_NEAR(
      local.geodetic_from_world(middle.T_world_body.translation).alt_ellipsoid_m, 401.0, 1e-6);
  EXPECT_THAT((*flight)->warnings(),
              ElementsAre(HasSubstr("log.csv: 1 rows (first in line 5) repeat the time"),
                          HasSubstr("3 rows (first in line 3) are out of time order")));
}

TEST(LogFlight, SaysThatGapsAreBridged) {
  const std::string unknown = " nan nan nan nan nan nan nan\n";
  const std::string known = "1 0 0 50 0 0 0 1\n2 10 0 50 0 0 0 1\n63.5 10 300 50 0 0 0 1\n";
  EXPECT_THAT(fly_text(known + "3" + unknown + "62" + unknown)->warnings(),
              Contains(HasSubstr("2 rows without a pose: the gaps, the longest of 61.5 s, are "
                                 "bridged without any sample")));
  EXPECT_THAT(fly_text("0" + unknown + known + "70" + unknown)->warnings(), IsEmpty())
      << "nothing lies between poses";
}

TEST(LogFlight, NamesFileLineColumnAndValueOfABadRow) {
  const std::string header = kHeader;
  const std::string row = "0,44,-123,400,0,0,0\n";
  EXPECT_THAT(error_of(header + row + "1,44,-123,high,0,0,0\n").message,
              AllOf(HasSubstr("log.csv:3: column 4 = 'high'"), HasSubstr("number")));
  EXPECT_THAT(error_of(header + row + "1,94,-123,400,0,0,0\n").message,
              HasSubstr("column 2 = '94': lat_deg must be in [-90, 90]"));
  EXPECT_THAT(error_of(header + row + "1,44,-123,400,0,0\n").message,
              HasSubstr("log.csv:3: 6 columns: must be 7"));
  EXPECT_THAT(
      error_of("t_s,lat,lon_deg,alt_ellipsoid_m,roll_deg,pitch_deg,yaw_deg\n" + row).message,
      AllOf(HasSubstr("log.csv:1: column 2 = 'lat'"), HasSubstr("t_s,lat_deg,lon_deg")));
  EXPECT_THAT(error_of("t_s,lat_deg\n" + row).message, HasSubstr("the header must be t_s,"));
  EXPECT_EQ(error_of(header + row + "x\n").code, ErrorCode::kUnreadable);
}

TEST(LogFlight, RefusesWhatIsNoFlight) {
  EXPECT_EQ(fly_log("/nonexistent.csv", frame()).error().code, ErrorCode::kNotFound);
  EXPECT_THAT(error_of(kHeader).message, HasSubstr("0 poses: a flight needs at least 2"));
  EXPECT_THAT(error_of("0 0 0 0 0 0 0 1\n").message, HasSubstr("1 poses"));
  EXPECT_THAT(error_of("1 0 0 0 0 1 0 0 0 0 1 0\n").message, HasSubstr("times.txt"));
}

}  // namespace
}  // namespace overfly::flight
