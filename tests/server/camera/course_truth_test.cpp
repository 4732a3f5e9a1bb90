// Where a course begins, and the wind in which it is flown.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/camera/image.hpp"
#include "core/text/number_text.hpp"
#include "server/camera/truth.hpp"
#include "server/worlds/scenario_world.hpp"
#include "tests/server/support/server_fixture.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server {
namespace {

using testing::small_scenario;

constexpr double kAirspeedMS = 25.0;

std::unique_ptr<TruthSource> truth_over(const Scenario& scenario, const OpenedWorld& opened) {
  auto truth = create_truth(scenario, opened.world);
  EXPECT_TRUE(truth.ok()) << (truth ? "" : truth.error().message);
  return truth ? std::move(*truth) : nullptr;
}

/// Grey imagery of 400 m x 300 m without elevation, as the field `world` of a scenario.
std::string bare_imagery(const std::filesystem::path& folder, const std::string& more = "") {
  overfly::testing::GeoTiff tiff;
  tiff.image = Image(200, 150, 1);
  tiff.left = 583000.0;
  tiff.top = 4356000.0;
  tiff.pixel = 2.0;
  overfly::testing::write_geotiff(folder / "ground.tif", tiff);
  return R"(world={"imagery":[{"file":")" + (folder / "ground.tif").string() +
         R"("}],"ground_height_m":200)" + more + "}";
}

/// Centre of the bounding box of a whole flight.
Eigen::Vector2d middle_of(TruthSource& truth) {
  constexpr std::int64_t kStepNs = kNsPerS / 2;
  Eigen::AlignedBox2d box;
  for (std::int64_t t_ns = 0; t_ns <= truth.duration_ns().value(); t_ns += kStepNs) {
    const auto state = truth.state_at(t_ns);
    EXPECT_TRUE(state.ok() && *state);
    if (!state || !*state) break;
    box.extend((*state)->T_world_body.translation.head<2>().eval());
  }
  return box.center();
}

TEST(CourseTruth, BeginsAtTheRunwayInItsDirection) {
  const Scenario scenario = small_scenario();
  const auto opened = open_scenario_world(scenario);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  const auto runway = opened->world.spec.runway;
  ASSERT_TRUE(runway.has_value());
  const auto truth = truth_over(scenario, *opened);
  ASSERT_NE(truth, nullptr);
  const auto first = truth->state_at(0);
  ASSERT_TRUE(first.ok() && *first);
  const LocalFrame& frame = opened->world.tiles->frame();
  const Eigen::Vector3d threshold =
      frame.world_from_geodetic({runway->lat_rad, runway->lon_rad, frame.origin().alt_ellipsoid_m});
  const Pose& T_world_body = (*first)->T_world_body;
  EXPECT_LT((T_world_body.translation - threshold).head<2>().norm(), 1e-6);
  EXPECT_GT(threshold.head<2>().norm(), 1.0) << "not the origin";
  const double yaw_rad = attitude_from(T_world_body.rotation).yaw_rad;
  EXPECT_NEAR(std::remainder(yaw_rad - runway->heading_rad, 2.0 * kPi), 0.0, 1e-6);
  EXPECT_GT(std::abs(std::remainder(yaw_rad, 2.0 * kPi)), 0.01) << "not the default";
}

TEST(CourseTruth, IsCentredOnImageryWithoutARunway) {
  const overfly::testing::TemporaryFolder folder;
  // 32 s.
  const std::string course =
      R"(flight.course={"airspeed_m_s":25,"leg_length_m":300,"length_m":800})";
  const Scenario plain = small_scenario({bare_imagery(folder.path()), course});
  const auto opened = open_scenario_world(plain);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  const auto truth = truth_over(plain, *opened);
  ASSERT_NE(truth, nullptr);
  // The origin is the centre.
  EXPECT_LT(middle_of(*truth).norm(), 1.0);
  EXPECT_GT((*truth->state_at(0))->T_world_body.translation.head<2>().norm(), 50.0);

  const Geodetic& centre = opened->world.tiles->frame().origin();
  const Scenario elsewhere = small_scenario(
      {bare_imagery(folder.path(),
                    R"(,"origin":{"lat_deg":)" + number_text(deg_from_rad(centre.lat_rad) + 0.01) +
                        R"(,"lon_deg":)" + number_text(deg_from_rad(centre.lon_rad)) +
                        R"(,"alt_ellipsoid_m":200})"),
       course});
  const auto other = open_scenario_world(elsewhere);
  ASSERT_TRUE(other.ok()) << other.error().message;
  const auto moved = truth_over(elsewhere, *other);
  ASSERT_NE(moved, nullptr);
  const Eigen::Vector2d centre_m =
      other->world.tiles->frame().world_from_geodetic(centre).head<2>();
  EXPECT_NEAR(centre_m.y(), -1110.0, 5.0);
  EXPECT_LT((middle_of(*moved) - centre_m).norm(), 1.0);
}

/// From the west at 5 m/s: it carries the aircraft to the east.
TEST(CourseTruth, WindBlowsFromItsDirection) {
  const Scenario scenario =
      small_scenario({R"(flight.course={"airspeed_m_s":25,"leg_length_m":400,"length_m":800,
                          "heading_deg":0,"dynamics":"piper_cub_third",
                          "wind":{"from_deg":270,"speed_m_s":5}})"});
  const auto opened = open_scenario_world(scenario);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  const auto truth = truth_over(scenario, *opened);
  ASSERT_NE(truth, nullptr);
  Eigen::Vector2d sum_m_s = Eigen::Vector2d::Zero();
  int count = 0;
  // On the first leg, after the first correction of the heading.
  for (std::int64_t t_ns = 5 * kNsPerS; t_ns <= 14 * kNsPerS; t_ns += kNsPerS / 10) {
    const auto state = truth->state_at(t_ns);
    ASSERT_TRUE(state.ok() && *state);
    const Eigen::Vector3d nose = (*state)->T_world_body.rotation * Eigen::Vector3d::UnitX();
    EXPECT_NEAR((*state)->airspeed_m_s, kAirspeedMS, 2.0);
    sum_m_s += ((*state)->v_body_world_m_s - (*state)->airspeed_m_s * nose).head<2>();
    ++count;
  }
  const Eigen::Vector2d wind_m_s = sum_m_s / count;
  EXPECT_NEAR(wind_m_s.x(), 5.0, 0.5);
  EXPECT_NEAR(wind_m_s.y(), 0.0, 0.5);
}

}  // namespace
}  // namespace overfly::server
