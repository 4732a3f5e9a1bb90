// Flight logs flown over a world: at their own place, and moved to another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/time.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/probes/probe_log.hpp"
#include "flight/replay/logged_flight.hpp"
#include "tests/flight/replay/csv_flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Ground that rises to the east by 10 m in 100 m.
class Slope final : public HeightQuery {
 public:
  [[nodiscard]] double ground_up_m(double east_m, double /*north_m*/) const override {
    return 0.1 * east_m;
  }
};

std::unique_ptr<TruthSource> flown_log(const testing::CsvFlight& log,
                                       const LogFlightOptions& options,
                                       const LocalFrame& world) {
  auto flight = fly_flight_log(log.mapping(), options, world, Slope(), {});
  EXPECT_TRUE(flight.ok()) << (flight ? "" : flight.error().message);
  return std::move(flight).value();
}

AircraftState state_of(TruthSource& flight, double t_s) {
  return **flight.state_at(ns_from_s(t_s));
}

class LoggedFlights : public ::testing::TestWithParam<bool> {
 protected:
  LoggedFlights() {
    if (GetParam()) options_.smooth.emplace();
  }
  testing::CsvFlight log_;
  LogFlightOptions options_;
};
INSTANTIATE_TEST_SUITE_P(SmoothedAndNot, LoggedFlights, ::testing::Bool());

TEST_P(LoggedFlights, LieAtTheirOwnPlaceOnTheEarth) {
  options_.geoid_separation_m = 48.0;
  // A world whose origin is 8 km away.
  const LocalFrame world(geodetic_from_deg(47.05, 8.08, 400.0));
  const auto flight = flown_log(log_, options_, world);
  EXPECT_NEAR(s_from_ns(*flight->duration_ns()), 90.0, 1e-6);
  for (const double t_s : {0.0, 12.34, 45.0, 89.9}) {
    const AircraftState state = state_of(*flight, t_s);
    const testing::CsvFlight::Row row = log_.row(100.0 + t_s);
    const Geodetic place = geodetic_from_deg(row.lat_deg, row.lon_deg, row.alt_msl_m + 48.0);
    EXPECT_LT((state.T_world_body.translation - world.world_from_geodetic(place)).norm(), 0.02);
    const Eigen::Quaterniond R_world_body =
        world.R_world_enu_at(place) * R_world_body_from(row.angles);
    EXPECT_LT(rotation_angle_rad(state.T_world_body.rotation, R_world_body), 2e-3);
    EXPECT_NEAR(state.v_body_world_m_s.x(), 20.0, 0.1);
  }
  EXPECT_FALSE(flight->state_at(ns_from_s(90.01))->has_value());
  EXPECT_FALSE(flight->state_at(-1).ok());
}

TEST_P(LoggedFlights, AreMovedAndTurned) {
  Rebase rebase;
  rebase.point = Rebase::Point::kStart;
  rebase.at = PlaceInWorld{-500.0, 700.0};
  rebase.lowest_agl_m = 120.0;
  rebase.turn_rad = rad_from_deg(90.0);  // the flight to the east goes south
  options_.rebase = rebase;
  const LocalFrame world(geodetic_from_deg(-35.0, 120.0, 10.0));
  const auto flight = flown_log(log_, options_, world);
  const AircraftState start = state_of(*flight, 0.0);
  EXPECT_NEAR(start.T_world_body.translation.x(), -500.0, 0.05);
  EXPECT_NEAR(start.T_world_body.translation.y(), 700.0, 0.05);
  const AircraftState later = state_of(*flight, 60.0);
  EXPECT_NEAR(later.T_world_body.translation.y(), 700.0 - 1200.0, 0.5);
  EXPECT_NEAR(later.v_body_world_m_s.y(), -20.0, 0.1);
  const double yaw_rad = attitude_from(later.T_world_body.rotation).yaw_rad;
  EXPECT_NEAR(wrap_pi(yaw_rad - log_.row(160.0).angles.yaw_rad - rad_from_deg(90.0)), 0.0, 2e-3);
  double lowest_m = 1e9;
  for (double t_s = 0.0; t_s < 89.9; t_s += 0.1) {
    const Eigen::Vector3d p = state_of(*flight, t_s).T_world_body.translation;
    lowest_m = std::min(lowest_m, p.z() - Slope().ground_up_m(p.x(), p.y()));
  }
  EXPECT_NEAR(lowest_m, 120.0, 0.1);
}

TEST_P(LoggedFlights, AreCentredOnAPlaceOfTheEarth) {
  Rebase rebase;
  const LocalFrame world(geodetic_from_deg(35.7, -120.7, 250.0));
  rebase.at = PlaceOnEarth{rad_from_deg(35.701), rad_from_deg(-120.7)};
  options_.rebase = rebase;
  options_.from_s = 110.0;
  options_.to_s = 150.0;
  const auto flight = flown_log(log_, options_, world);
  EXPECT_NEAR(s_from_ns(*flight->duration_ns()), 40.0, 1e-6);
  const double middle_east_m = 0.5 * (state_of(*flight, 0.0).T_world_body.translation.x() +
                                      state_of(*flight, 39.99).T_world_body.translation.x());
  EXPECT_NEAR(middle_east_m, 0.0, 0.5);
}

TEST_P(LoggedFlights, ReadOnlyFilesThatThePolicyAllows) {
  const auto flight = fly_flight_log(log_.mapping(),
                                     options_,
                                     LocalFrame(geodetic_from_deg(0, 0, 0)),
                                     Slope(),
                                     SourcePolicy::inside({"/nonexistent"}));
  ASSERT_FALSE(flight.ok());
  EXPECT_THAT(flight.error().message, HasSubstr("pieces.0.file"));
}

TEST(LoggedFlight, ShiftsTheTimesOfAttitudes) {
  const testing::CsvFlight log;
  LogFlightOptions options;
  options.time_offset_s = 0.5;
  // The first position with attitudes on both sides is that of 100.6 s.
  const auto flight = flown_log(log, options, log.frame());
  const double roll_rad = attitude_from(state_of(*flight, 32.4).T_world_body.rotation).roll_rad;
  EXPECT_NEAR(roll_rad, log.row(132.5).angles.roll_rad, 2e-3);
}

TEST(LoggedFlight, FliesEveryLoggedAttitude) {
  // A roll of 2 Hz, far faster than the positions at 5 Hz.
  const testing::CsvFlight log;
  const auto roll_rad = [](double t_s) { return 0.5 * std::sin(4.0 * kPi * t_s + 1.0); };
  std::string rows = "t,roll,pitch,yaw\n";
  for (int i = 0; i <= 9000; ++i) {
    const double t_s = 100.0 + 0.01 * i;
    rows += number_text(t_s) + ',' + number_text(roll_rad(t_s)) + ",0,0\n";
  }
  testing::write_text(log.mapping().parent_path() / "att.csv", rows);
  const auto flight = flown_log(log, {}, log.frame());
  for (double t_s = 20.005; t_s < 22.0; t_s += 0.01) {  // half way between two attitudes
    const AircraftState state = state_of(*flight, t_s);
    const testing::CsvFlight::Row row = log.row(100.0 + t_s);
    const Eigen::Quaterniond R_world_body =
        log.frame().R_world_enu_at(geodetic_from_deg(row.lat_deg, row.lon_deg, row.alt_msl_m)) *
        R_world_body_from({roll_rad(100.0 + t_s), 0.0, 0.0});
    EXPECT_LT(rotation_angle_rad(state.T_world_body.rotation, R_world_body), 1.2e-3);
    const double rate_rad_s = 2.0 * kPi * std::cos(4.0 * kPi * (100.0 + t_s) + 1.0);
    EXPECT_NEAR(state.omega_body_rad_s.x(), rate_rad_s, 6e-3);
  }
}

TEST_P(LoggedFlights, WarnOfHeightsAboveSeaLevel) {
  const testing::CsvFlight& log = log_;
  options_.sea_level_m = [](const Geodetic& place) { return -deg_from_rad(place.lat_rad); };
  const auto warned = Contains(HasSubstr(
      "the heights of GPS are above mean sea level and, without geoid_separation_m, are flown as "
      "heights above the ellipsoid: they may be wrong by about 47 m here"));
  EXPECT_THAT(flown_log(log, options_, log.frame())->warnings(), warned);
  options_.geoid_separation_m = 0.0;
  EXPECT_THAT(flown_log(log, options_, log.frame())->warnings(), Not(warned));
  options_.geoid_separation_m.reset();
  options_.rebase.emplace().at = PlaceInWorld{0.0, 0.0};
  EXPECT_THAT(flown_log(log, options_, log.frame())->warnings(), Not(warned));
}

TEST(LoggedFlight, ReadsOnlyASliceOfALargeLog) {
  const overfly::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "flight.bin";
  const auto format = logs::LogFormat::kDataFlash;
  ASSERT_TRUE(logs::write_probe_log(file, format, logs::kIndexedLogBytes).ok());
  {
    std::fstream damaged(file, std::ios::binary | std::ios::in | std::ios::out);
    damaged.seekp(5'000'000);
    damaged << std::string(300, '\0');
  }
  const auto log = logs::open_log(file);
  ASSERT_TRUE(log.ok() && log->truth.has_value());
  const std::filesystem::path index = file.string() + ".overfly-index";
  ASSERT_TRUE(std::filesystem::exists(index));
  LogFlightOptions options;
  options.to_s = s_from_ns(*log->streams[log->truth->position].last_ns) - 1.0;
  options.from_s = *options.to_s - 5.0;
  const LocalFrame world(geodetic_from_deg(47.0, 8.0, 400.0));
  for (const bool smooth : {false, true}) {
    if (smooth) options.smooth.emplace();
    const auto sliced = fly_flight_log(file, options, world, Slope(), {});
    ASSERT_TRUE(sliced.ok()) << sliced.error().message;
    const std::string kept = overfly::testing::read_text(index);
    std::filesystem::remove(index);
    const auto whole = fly_flight_log(file, options, world, Slope(), {});
    ASSERT_TRUE(whole.ok()) << whole.error().message;
    EXPECT_EQ(overfly::testing::read_text(index), kept);
    // The damage in front of the slice is only met where the whole log is read.
    EXPECT_THAT((*whole)->warnings(), Contains(HasSubstr("skipped")));
    EXPECT_THAT((*sliced)->warnings(), Not(Contains(HasSubstr("skipped"))));
    EXPECT_EQ((*sliced)->duration_ns(), (*whole)->duration_ns());
    EXPECT_GT((*sliced)->duration_ns(), 4 * kNsPerS);
    for (const double t_s : {0.0, 1.234, 4.0}) {
      const Pose a = state_of(**sliced, t_s).T_world_body;
      const Pose b = state_of(**whole, t_s).T_world_body;
      EXPECT_EQ(a.translation, b.translation);
      EXPECT_EQ(a.rotation.coeffs(), b.rotation.coeffs());
    }
  }
}

TEST(LoggedFlight, ReportsJumpsAsWarnings) {
  const testing::CsvFlight log(true);
  LogFlightOptions options;
  options.smooth.emplace();
  const auto flight = flown_log(log, options, log.frame());
  EXPECT_THAT(flight->warnings(),
              ::testing::Contains(HasSubstr("1 position left out at 150.000 s")));
  EXPECT_EQ(flight->description(), "log: log.json, GPS with the attitude of ATT, smoothed");
}

TEST(LoggedFlight, NamesAPositionThatIsDamaged) {
  for (const double off_deg : {0.1, 20.0}) {
    const testing::CsvFlight log(true, off_deg);
    LogFlightOptions options;
    const auto flown = [&] {
      return fly_flight_log(log.mapping(), options, log.frame(), Slope(), {});
    };
    const auto flight = flown();
    EXPECT_EQ(flight.ok(), off_deg < 1.0);
    if (!flight) {
      EXPECT_THAT(flight.error().message,
                  HasSubstr("log.json: GPS: the position at 150.000000000 s of the vehicle's clock "
                            "is 2"));
      EXPECT_THAT(flight.error().message, HasSubstr(" km away from the middle of the flight"));
    }
    options.far_poses = true;
    EXPECT_TRUE(flown().ok());
    options.far_poses = false;
    options.smooth.emplace();
    EXPECT_TRUE(flown().ok());
  }
}

TEST(LoggedFlight, IsTakenFromFilesThatAreLogs) {
  const testing::CsvFlight log;
  EXPECT_TRUE(is_flight_log(log.mapping()));
  EXPECT_FALSE(is_flight_log(log.mapping().parent_path() / "gps.csv"));
  EXPECT_FALSE(is_flight_log("/nonexistent"));
}

}  // namespace
}  // namespace overfly::flight
