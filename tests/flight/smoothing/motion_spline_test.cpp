// Splines and their derivatives.
#include <gtest/gtest.h>

#include "flight/smoothing/motion_spline.hpp"
#include "flight/smoothing/noise_level.hpp"
#include "flight/smoothing/spline_fit.hpp"
#include "tests/flight/smoothing/sampled_flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::smoothing {
namespace {

using overfly::testing::larger_error;

TEST(SplineKnots, CoverATimeAndLimitPlaces) {
  const SplineKnots knots = SplineKnots::covering(1.0, 2.05, 0.1);
  EXPECT_EQ(knots.segments, 11U);
  EXPECT_EQ(knots.place(0.0).segment, 0U);
  EXPECT_EQ(knots.place(0.0).u, 0.0);
  EXPECT_EQ(knots.place(9.0).segment, 10U);
  EXPECT_EQ(knots.place(9.0).u, 1.0);
  EXPECT_NEAR(knots.place(1.25).u, 0.5, 1e-12);
}

TEST(PositionSpline, ReproducesACubicAndItsDerivatives) {
  // The control points of a cubic p(t) are its polar form at the inner knots; for p = t^3 and h = 1
  // that of knots k-1, k, k+1 is (k-1) k (k+1).
  PositionSpline spline{{0.0, 1.0, 6}, {}};
  for (int i = 0; i < 9; ++i) {
    const double k = i - 1.0;
    spline.control_m.emplace_back((k - 1) * k * (k + 1), k, 2.0);
  }
  for (const double t : {0.0, 0.3, 2.5, 5.99}) {
    EXPECT_NEAR(spline.position_m(t).x(), t * t * t, 1e-10);
    EXPECT_NEAR(spline.velocity_m_s(t).x(), 3 * t * t, 1e-10);
    EXPECT_NEAR(spline.acceleration_m_s2(t).x(), 6 * t, 1e-10);
    EXPECT_NEAR(spline.velocity_m_s(t).y(), 1.0, 1e-12);
    EXPECT_NEAR(spline.position_m(t).z(), 2.0, 1e-12);
  }
}

TEST(RotationSpline, RateAgreesWithDifferencesOfRotations) {
  RotationSpline spline{{0.0, 0.5, 4}, {}};
  NormalNoise noise(3);
  for (std::size_t i = 0; i < spline.knots.control_points(); ++i) {
    spline.control.push_back(rotation_from_vector({noise.draw(), noise.draw(), noise.draw()}));
  }
  for (const double t_s : {0.1, 0.49, 0.51, 1.3, 1.9}) {
    constexpr double kStepS = 1e-5;
    const Eigen::Vector3d expected =
        vector_from_rotation(spline.rotation(t_s - kStepS).conjugate() *
                             spline.rotation(t_s + kStepS)) /
        (2 * kStepS);
    EXPECT_LT((spline.angular_rate_rad_s(t_s) - expected).norm(), 1e-6);
  }
}

TEST(RotationVector, InvertsAtAllAngles) {
  for (const double angle : {0.0, 1e-12, 1e-5, 0.5, 3.0, 3.14159265}) {
    const Eigen::Vector3d v = angle * Eigen::Vector3d(0.6, -0.64, 0.48);
    EXPECT_LT((vector_from_rotation(rotation_from_vector(v)) - v).norm(), 1e-7) << angle;
  }
}

TEST(NoiseLevel, IsFoundDespiteTheMotionAndJumps) {
  testing::Recording recording = testing::record({});
  for (std::size_t i = 50; i < recording.positions.size(); i += 100) {
    recording.positions[i].p_world_m.x() += 300.0;
  }
  const PositionNoise noise = position_noise(recording.positions);
  // 1300 triples: the median's own error is about 3 %; jerk in the reversals adds some.
  EXPECT_NEAR(noise.horizontal_m, 0.2, 0.02);
  EXPECT_NEAR(noise.vertical_m, 0.3, 0.03);
  EXPECT_NEAR(attitude_noise_rad(recording.attitudes), rad_from_deg(0.2), rad_from_deg(0.01));
  EXPECT_EQ(position_noise({}).horizontal_m, 0.0);
}

TEST(SplineFit, IsTheSameWhereverWindowsEnd) {
  const testing::Recording recording = testing::record({});
  const std::span<const PositionSample> positions = recording.positions;
  const std::span<const AttitudeSample> attitudes = recording.attitudes;
  const PositionNoise noise{0.2, 0.3};
  // Windows end at 60 s and 120 s of the whole, and at 60 s of the part, which is 90 s.
  const PositionSpline whole =
      fit_positions(positions, SplineKnots::covering(0.0, 129.9, 0.1), noise, 50.0, nullptr)
          .value();
  const PositionSpline part =
      fit_positions(
          positions.subspan(300), SplineKnots::covering(30.0, 129.9, 0.1), noise, 50.0, nullptr)
          .value();
  const RotationSpline turned =
      fit_rotations(attitudes, SplineKnots::covering(0.0, 129.9, 0.05), 0.004, 0.3, nullptr)
          .value();
  const RotationSpline turned_part =
      fit_rotations(
          attitudes.subspan(1500), SplineKnots::covering(30.0, 129.9, 0.05), 0.004, 0.3, nullptr)
          .value();
  double worst_m = 0.0;
  double worst_rad = 0.0;
  for (double t_s = 40.0; t_s < 128.0; t_s += 0.03) {
    worst_m = larger_error(worst_m, (whole.position_m(t_s) - part.position_m(t_s)).norm());
    worst_rad = larger_error(worst_rad,
                             rotation_angle_rad(turned.rotation(t_s), turned_part.rotation(t_s)));
  }
  EXPECT_LT(worst_m, 1e-3);  // the solver's tolerance
  EXPECT_LT(worst_rad, 1e-5);
}

}  // namespace
}  // namespace overfly::flight::smoothing
