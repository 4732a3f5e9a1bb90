// Moments of a flight of known motion against its closed form.
#include "flight/playback/topics/flight_moments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/motion/pose.hpp"
#include "flight/playback/play.hpp"
#include "flight/playback/topics/topic_outputs.hpp"
#include "tests/flight/playback/circle_flight.hpp"

namespace overfly::flight::playback {
namespace {

using testing::CircleFlight;
using testing::frame_of_circles;
using ::testing::HasSubstr;

PlayedFlight circles_played(double length_s, double rate_hz = 100.0) {
  return {std::make_unique<CircleFlight>(length_s),
          frame_of_circles(),
          1'700'000'000'000'000'000,
          rate_hz};
}

TEST(FlightMoments, HaveTheFlightAndWhatItsSensorsWouldMeasure) {
  auto moments = FlightMoments::create(circles_played(10.0));
  ASSERT_TRUE(moments.ok()) << moments.error().message;
  ASSERT_EQ(moments->count(), 1001);
  EXPECT_EQ(moments->epoch_ns(), 1'700'000'000'000'000'000);
  const LocalFrame frame = frame_of_circles();
  // Normal gravity at 47.3 deg N by the formula of 1980 (Moritz), less 3.086e-6 1/s^2 a metre.
  const double sin2 = std::pow(std::sin(rad_from_deg(47.3)), 2);
  const double sin2_double = std::pow(std::sin(rad_from_deg(94.6)), 2);
  const double ground_m_s2 = 9.780327 * (1.0 + 0.0053024 * sin2 - 0.0000058 * sin2_double);
  for (const std::int64_t number : {400, 0, 999, 17, 1000}) {
    const auto found = moments->at(number);
    ASSERT_TRUE(found.ok() && *found) << number;
    const FlightMoment& moment = **found;
    const AircraftState truth = CircleFlight::at(10'000'000 * number);
    EXPECT_EQ(moment.t_ns, truth.t_ns);
    EXPECT_EQ(moment.T_map_body.translation, truth.T_world_body.translation);
    EXPECT_EQ(moment.T_map_body.rotation.coeffs(), truth.T_world_body.rotation.coeffs());
    const Geodetic place = frame.geodetic_from_world(truth.T_world_body.translation);
    EXPECT_EQ(moment.gps.place.lat_rad, place.lat_rad);
    EXPECT_NEAR(moment.gps.velocity_ned_m_s.x(), truth.v_body_world_m_s.y(), 1e-3);
    EXPECT_NEAR(moment.gps.velocity_ned_m_s.y(), truth.v_body_world_m_s.x(), 1e-3);
    EXPECT_NEAR(moment.gps.velocity_ned_m_s.z(), -2.0, 1e-3);
    EXPECT_TRUE(std::isnan(moment.gps.horizontal_accuracy_m));
    EXPECT_EQ(moment.imu.angular_rate_rad_s, truth.omega_body_rad_s);
    // Towards the centre with v^2/r = 3.125 m/s^2, to the right of the flight; gravity is 1e-4 rad
    // off the world's axis at this distance. At the ends the mean lies a quarter of the step away.
    const double g = ground_m_s2 - 3.086e-6 * place.alt_ellipsoid_m;
    const Eigen::Vector3d level(0.0, 3.125, -g);
    const Eigen::Vector3d expected = Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitX()) * level;
    EXPECT_LT((moment.imu.acceleration_m_s2 - expected).norm(), 3e-3) << number;
  }
  for (const std::int64_t number : {std::int64_t{-1}, std::int64_t{1001}}) {
    const auto found = moments->at(number);
    ASSERT_TRUE(found.ok());
    EXPECT_FALSE(*found);
  }
}

TEST(FlightMoments, AreOnAMapOfTheirOwnWithoutAnOrigin) {
  PlayedFlight played{std::make_unique<CircleFlight>(4.0, std::nullopt), frame_of_circles(), {}};
  played.is_placed = false;
  auto moments = FlightMoments::create(std::move(played));
  ASSERT_TRUE(moments.ok());
  EXPECT_EQ(moments->epoch_ns(), 1'000'000'000);
  const auto first = moments->at(0);
  ASSERT_TRUE(first.ok() && *first);
  EXPECT_LT((*first)->T_map_body.translation.norm(), 6e-4);  // half a millimetre, and 1e-9 deg
  const auto later = moments->at(100);
  ASSERT_TRUE(later.ok() && *later);
  const LocalFrame map(moments->map_origin());
  EXPECT_LT(
      (map.world_from_geodetic((*later)->gps.place) - (*later)->T_map_body.translation).norm(),
      1e-6);
  EXPECT_LT(rotation_angle_rad((*later)->T_map_body.rotation,
                               map.R_world_enu_at((*later)->gps.place) * (*later)->R_enu_body),
            1e-9);
}

TEST(FlightMoments, SayWhatCannotBePlayed) {
  const auto refused = FlightMoments::create(circles_played(4.0, 0.5));
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("rate = 0.5 Hz: must be in [1, 1000]"));
}

TEST(LcmOutput, SaysWhatIsWrongWithItsUrl) {
  const std::atomic<bool> stop{false};
  PlaybackPorts ports;
  ports.now = [] { return PlaybackClock::TimePoint(); };
  ports.commands = [] { return std::vector<PlaybackCommand>(); };
  for (const auto& [url, text] :
       {std::pair("file:///tmp/none.lcm", "mode=w"), std::pair("smoke://", "smoke")}) {
    auto moments = FlightMoments::create(circles_played(4.0));
    const auto output = lcm_output(std::move(*moments), url);
    const auto played = play(*output, {}, ports, stop);
    ASSERT_FALSE(played.ok()) << url;
    // Without LCM the error says so instead.
    if (played.error().code != ErrorCode::kUnsupported) {
      EXPECT_THAT(played.error().message, HasSubstr(text));
    }
  }
}

}  // namespace
}  // namespace overfly::flight::playback
