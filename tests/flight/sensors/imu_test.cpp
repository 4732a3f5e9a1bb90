// The inertial unit: integrated back, and its noise by Allan's deviation.
#include "flight/sensors/imu.hpp"

#include <gtest/gtest.h>

#include <GeographicLib/NormalGravity.hpp>
#include <cmath>
#include <memory>

#include "core/time.hpp"
#include "flight/flight.hpp"
#include "flight/gravity.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight {
namespace {

using overfly::testing::larger_error;

constexpr double kGravity = 9.80665;

TEST(NormalGravity, IsThatOfWgs84) {
  // WGS84's gravity at the equator and the poles (NGA.STND.0036, table 3.6).
  EXPECT_NEAR(normal_gravity_m_s2(geodetic_from_deg(0, 0, 0)), 9.7803253359, 1e-9);
  EXPECT_NEAR(normal_gravity_m_s2(geodetic_from_deg(90, 0, 0)), 9.8321849379, 1e-9);
  // GeographicLib evaluates the ellipsoid's field itself.
  const auto& field = GeographicLib::NormalGravity::WGS84();
  for (const double lat_deg : {-35.0, 10.0, 45.0, 71.0}) {
    for (const double alt_m : {0.0, 300.0, 4000.0}) {
      double gamma_y = 0.0, gamma_z = 0.0;
      field.Gravity(lat_deg, alt_m, gamma_y, gamma_z);
      EXPECT_NEAR(normal_gravity_m_s2(geodetic_from_deg(lat_deg, 0, alt_m)),
                  std::hypot(gamma_y, gamma_z),
                  5e-7);
    }
  }
}

/// Straight and level for ever, or banked in a steady turn.
class SteadyFlight final : public TruthSource {
 public:
  explicit SteadyFlight(double turn_rate_rad_s = 0.0) : turn_(turn_rate_rad_s) {}
  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override { return std::nullopt; }
  [[nodiscard]] std::string description() const override { return "steady"; }

 private:
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* /*cancel*/) override {
    constexpr double kSpeed = 25.0;
    const double yaw = turn_ * s_from_ns(t_ns);
    AircraftState state;
    state.t_ns = t_ns;
    const double bank = std::atan(turn_ * kSpeed / kGravity);
    state.T_world_body.rotation = R_world_body_from({bank, 0.0, yaw});
    state.v_body_world_m_s = kSpeed * Eigen::Vector3d(std::sin(yaw), std::cos(yaw), 0.0);
    return std::optional(state);
  }

  double turn_;
};

TEST(Imu, MeasuresGravityAtRestAndLoadInATurn) {
  SteadyFlight level;
  const auto at_rest = synthesize_imu(level, kNsPerS, ImuModel::ideal(), kGravity, 1).value();
  ASSERT_EQ(at_rest.size(), 201U);
  EXPECT_EQ(at_rest[1].sample.t_ns, 5'000'000);
  // Forward-right-down: the seat pushes up, along -z.
  EXPECT_LT((at_rest[50].sample.acceleration_m_s2 - Eigen::Vector3d(0, 0, -kGravity)).norm(), 1e-9);
  EXPECT_LT(at_rest[50].sample.angular_rate_rad_s.norm(), 1e-12);

  const double turn = 0.3;
  SteadyFlight turning(turn);
  const auto reading =
      synthesize_imu(turning, kNsPerS, ImuModel::ideal(), kGravity, 1).value()[100];
  const double bank = std::atan(turn * 25.0 / kGravity);
  // Coordinated: no side force, load factor 1 / cos(bank). Means over 5 ms: 1e-7 of the whole.
  EXPECT_LT(
      (reading.sample.acceleration_m_s2 - Eigen::Vector3d(0, 0, -kGravity / std::cos(bank))).norm(),
      1e-5);
  EXPECT_LT((reading.sample.angular_rate_rad_s -
             Eigen::Vector3d(0.0, turn * std::sin(bank), turn * std::cos(bank)))
                .norm(),
            1e-6);
}

TEST(Imu, IntegratesBackToTheFlightThatMadeIt) {
  CourseParameters course;
  course.roll_rate_max_rad_s = rad_from_deg(65.0);
  course.length_m = 2400.0;
  course.leg_length_m = 300.0;  // most of it in turns
  const auto ground = std::make_shared<FlatGround>(0.0);
  const auto measured = fly_course(course, ground).value();
  const auto truth = fly_course(course, ground).value();
  constexpr std::int64_t kEndNs = 60 * kNsPerS;
  const auto readings = synthesize_imu(*measured, kEndNs, ImuModel::ideal(), kGravity, 1).value();
  ASSERT_EQ(readings.size(), 12001U);

  AircraftState state = truth->state_at(0).value().value();
  Eigen::Quaterniond R = state.T_world_body.rotation;
  Eigen::Vector3d v = state.v_body_world_m_s;
  Eigen::Vector3d p = state.T_world_body.translation;
  double worst_m = 0.0, worst_rad = 0.0;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const bool half = k == 0 || k + 1 == readings.size();
    const double dt_s = half ? 0.0025 : 0.005;
    const Eigen::Vector3d turn = readings[k].sample.angular_rate_rad_s * dt_s;
    const auto rotated = [&](double share) -> Eigen::Quaterniond {
      const double angle = share * turn.norm();
      if (angle == 0.0) return R;
      return R * Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn.normalized()));
    };
    // The mean is stamped in the middle of its interval, or at the end of a half one.
    const double middle = k == 0 ? 0.0 : half ? 1.0 : 0.5;
    const Eigen::Vector3d a =
        rotated(middle) * readings[k].sample.acceleration_m_s2 - Eigen::Vector3d(0, 0, kGravity);
    p += v * dt_s + 0.5 * a * dt_s * dt_s;
    v += a * dt_s;
    R = rotated(1.0).normalized();
    const std::int64_t end_ns =
        half && k > 0 ? kEndNs : readings[k].sample.t_ns + ns_from_s(0.0025);
    const AircraftState wanted = truth->state_at(end_ns).value().value();
    worst_m = larger_error(worst_m, (p - wanted.T_world_body.translation).norm());
    worst_rad = larger_error(worst_rad, rotation_angle_rad(R, wanted.T_world_body.rotation));
  }
  std::printf("[ IMU      ] 60 s integrated: %.4f m, %.2e rad\n", worst_m, worst_rad);
  EXPECT_LT(worst_m, 0.05);
  EXPECT_LT(worst_rad, 1e-8);
}

/// Overlapping Allan deviation of one axis at a cluster of `m` samples (IEEE Std 952-1997,
/// annex C).
double allan_deviation(const std::vector<double>& values, std::size_t m, double sample_s) {
  std::vector<double> integral(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    integral[i + 1] = integral[i] + values[i] * sample_s;
  }
  const double tau_s = static_cast<double>(m) * sample_s;
  double sum = 0.0;
  const std::size_t count = integral.size() - 2 * m;
  for (std::size_t i = 0; i < count; ++i) {
    const double d = integral[i + 2 * m] - 2.0 * integral[i + m] + integral[i];
    sum += d * d;
  }
  return std::sqrt(sum / (2.0 * tau_s * tau_s * static_cast<double>(count)));
}

TEST(Imu, HasTheNoiseDensitiesItWasAskedFor) {
  ImuModel white;
  white.gyroscope_walk_rad_s2_sqrt_hz = 0.0;
  white.accelerometer_walk_m_s3_sqrt_hz = 0.0;
  SteadyFlight flight;
  const auto readings = synthesize_imu(flight, 600 * kNsPerS, white, kGravity, 7).value();
  std::vector<double> gyroscope, accelerometer;
  for (const ImuReading& reading : readings) {
    gyroscope.push_back(reading.sample.angular_rate_rad_s.x());
    accelerometer.push_back(reading.sample.acceleration_m_s2.y());
  }
  // sigma(tau) = density / sqrt(tau): slope -1/2. 600 s hold 600 clusters of 1 s: 4 % each.
  for (const auto& [tau_s, within] : {std::pair{0.05, 0.02}, {1.0, 0.12}}) {
    const auto m = static_cast<std::size_t>(tau_s * 200.0);
    const double scale = std::sqrt(tau_s);
    EXPECT_NEAR(allan_deviation(gyroscope, m, 0.005) * scale / 1.6968e-4, 1.0, within) << tau_s;
    EXPECT_NEAR(allan_deviation(accelerometer, m, 0.005) * scale / 2.0e-3, 1.0, within) << tau_s;
  }
}

TEST(Imu, HasTheBiasWalksItWasAskedFor) {
  ImuModel walk = ImuModel::ideal();
  walk.gyroscope_walk_rad_s2_sqrt_hz = 1.9393e-5;
  walk.accelerometer_walk_m_s3_sqrt_hz = 3.0e-3;
  SteadyFlight flight;
  const auto readings = synthesize_imu(flight, 600 * kNsPerS, walk, kGravity, 11).value();
  std::vector<double> gyroscope, accelerometer;
  for (const ImuReading& reading : readings) {
    gyroscope.push_back(reading.sample.angular_rate_rad_s.z());
    accelerometer.push_back(reading.sample.acceleration_m_s2.x());
  }
  EXPECT_EQ(readings.back().gyroscope_bias_rad_s.z(), gyroscope.back());
  // sigma(tau) = walk * sqrt(tau / 3): slope +1/2.
  for (const auto& [tau_s, within] : {std::pair{0.5, 0.08}, {4.0, 0.2}}) {
    const auto m = static_cast<std::size_t>(tau_s * 200.0);
    const double scale = std::sqrt(3.0 / tau_s);
    EXPECT_NEAR(allan_deviation(gyroscope, m, 0.005) * scale / 1.9393e-5, 1.0, within) << tau_s;
    EXPECT_NEAR(allan_deviation(accelerometer, m, 0.005) * scale / 3.0e-3, 1.0, within) << tau_s;
  }
}

using Axes = std::array<std::vector<double>, 3>;

/// Root mean square of the deviations of three axes with equal noise.
double allan_deviation(const Axes& axes, double tau_s) {
  double sum = 0.0;
  for (const std::vector<double>& values : axes) {
    const auto m = static_cast<std::size_t>(std::llround(tau_s * 200.0));
    sum += std::pow(allan_deviation(values, m, 0.005), 2);
  }
  return std::sqrt(sum / 3.0);
}

/// Slope of the deviation over log(tau) between two clusters.
double allan_slope(const Axes& axes, double tau1_s, double tau2_s) {
  const double ratio = allan_deviation(axes, tau2_s) / allan_deviation(axes, tau1_s);
  return std::log(ratio) / std::log(tau2_s / tau1_s);
}

TEST(Imu, HasBothSlopesAndCoefficientsOverTwoHours) {
  SteadyFlight flight;
  const ImuModel model;
  const auto readings = synthesize_imu(flight, 7200 * kNsPerS, model, kGravity, 23).value();
  Axes gyroscope, accelerometer;
  for (const ImuReading& reading : readings) {
    for (int axis = 0; axis < 3; ++axis) {
      gyroscope[axis].push_back(reading.sample.angular_rate_rad_s(axis));
      accelerometer[axis].push_back(reading.sample.acceleration_m_s2(axis));
    }
  }
  // IEEE Std 952-1997, annex C: sigma^2(tau) = N^2 / tau + K^2 tau / 3. N is read where its term
  // is at least 99 % of the sum, K after N's term was taken off.
  const auto walk = [](const Axes& axes, double n, double tau_s) {
    return std::sqrt((std::pow(allan_deviation(axes, tau_s), 2) - n * n / tau_s) * 3.0 / tau_s);
  };
  const double n_gyroscope = allan_deviation(gyroscope, 1.0);
  const double n_accelerometer = allan_deviation(accelerometer, 0.1) * std::sqrt(0.1);
  const double k_gyroscope = walk(gyroscope, n_gyroscope, 30.0);
  const double k_accelerometer = walk(accelerometer, n_accelerometer, 3.0);
  const double ratios[] = {n_gyroscope / model.gyroscope_noise_rad_s_sqrt_hz,
                           n_accelerometer / model.accelerometer_noise_m_s2_sqrt_hz,
                           k_gyroscope / model.gyroscope_walk_rad_s2_sqrt_hz,
                           k_accelerometer / model.accelerometer_walk_m_s3_sqrt_hz};
  std::printf("[ ALLAN    ] measured / asked: N %.3f %.3f, K %.3f %.3f\n",
              ratios[0],
              ratios[1],
              ratios[2],
              ratios[3]);
  for (const double ratio : ratios) EXPECT_NEAR(ratio, 1.0, 0.1);
  std::printf("[ ALLAN    ] slopes: %.3f %.3f %.3f\n",
              allan_slope(gyroscope, 0.05, 0.5),
              allan_slope(accelerometer, 0.01, 0.05),
              allan_slope(accelerometer, 5.0, 20.0));
  EXPECT_NEAR(allan_slope(gyroscope, 0.05, 0.5), -0.5, 0.05);
  EXPECT_NEAR(allan_slope(accelerometer, 0.01, 0.05), -0.5, 0.05);
  EXPECT_NEAR(allan_slope(accelerometer, 5.0, 20.0), 0.5, 0.05);
}

TEST(Imu, RecordedSamplesGetTheirBiasesBack) {
  SteadyFlight flight(0.2);
  const auto readings = synthesize_imu(flight, 10 * kNsPerS, {}, kGravity, 5).value();
  std::vector<ImuSample> samples;
  // The last one is of half an interval, which a run does not record.
  for (std::size_t k = 0; k + 1 < readings.size(); ++k) samples.push_back(readings[k].sample);
  const auto again = with_biases(samples, {}, 5).value();
  ASSERT_EQ(again.size(), samples.size());
  for (std::size_t k = 0; k < again.size(); ++k) {
    ASSERT_EQ(again[k].sample.angular_rate_rad_s, samples[k].angular_rate_rad_s) << k;
    ASSERT_EQ(again[k].gyroscope_bias_rad_s, readings[k].gyroscope_bias_rad_s) << k;
    ASSERT_EQ(again[k].accelerometer_bias_m_s2, readings[k].accelerometer_bias_m_s2) << k;
  }
  samples.erase(samples.begin() + 3);
  const auto refused = with_biases(samples, {}, 5);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "sample 3: t_ns = 20000000: must be 15000000");
}

TEST(Imu, IsTheSameForTheSameSeedOnly) {
  SteadyFlight flight;
  const auto a = synthesize_imu(flight, kNsPerS, {}, kGravity, 3).value();
  const auto b = synthesize_imu(flight, kNsPerS, {}, kGravity, 3).value();
  const auto c = synthesize_imu(flight, kNsPerS, {}, kGravity, 4).value();
  EXPECT_EQ(a[77].sample.acceleration_m_s2, b[77].sample.acceleration_m_s2);
  EXPECT_NE(a[77].sample.acceleration_m_s2, c[77].sample.acceleration_m_s2);
}

TEST(Imu, RefusesWhatCannotBe) {
  SteadyFlight flight;
  ImuModel model;
  model.rate_hz = 0.0;
  auto refused = synthesize_imu(flight, kNsPerS, model, kGravity, 1);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("imu.rate_hz = 0"), std::string::npos);
  model = {};
  model.accelerometer_walk_m_s3_sqrt_hz = -1.0;
  EXPECT_FALSE(model.validate().ok());
  const auto cancelled = synthesize_imu(flight, kNsPerS, {}, kGravity, 1, [] { return false; });
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace overfly::flight
