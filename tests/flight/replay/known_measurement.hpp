// One measurement of each sensor, for logs of all formats that are made by hand.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/motion/pose.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/replay/flown_sensors.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::testing {

// An aircraft that rolls to the right, raises its nose and turns to the right, in a field that
// points north-east-down of it: all in body axes forward-right-down.
inline const Eigen::Vector3d kRate(0.125, 0.25, 0.5);
inline const Eigen::Vector3d kForce(1.5, -0.75, -9.5);
inline const Eigen::Vector3d kFieldUt(20.0, 5.0, 40.0);
inline constexpr double kPressurePa = 95000.0;
inline constexpr double kAirspeedMS = 25.0;
inline constexpr double kDynamicPa = 0.5 * 1.225 * 25.0 * 25.0;
inline constexpr double kRangeM = 43.25;
inline constexpr int kSteps = 20;
inline constexpr std::int64_t kMeasuredEveryNs = 100'000'000;
inline constexpr double kLatStepDeg = 2.25e-5;  // 25 m/s

/// @param samples  one of each step
inline void expect_inertial(const std::vector<ImuSample>& samples, std::int64_t first_ns = 0) {
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(kSteps));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].t_ns, first_ns + static_cast<std::int64_t>(i) * kMeasuredEveryNs);
    EXPECT_LT((samples[i].angular_rate_rad_s - kRate).norm(), 1e-7);
    EXPECT_LT((samples[i].acceleration_m_s2 - kForce).norm(), 1e-6);
  }
}

inline void expect_field(const std::vector<MagnetometerSample>& samples) {
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(kSteps));
  EXPECT_EQ(samples[3].t_ns, 3 * kMeasuredEveryNs);
  EXPECT_LT((samples[3].field_ut - kFieldUt).norm(), 1e-5);
}

inline void expect_air(const SensorSamples& samples) {
  ASSERT_EQ(samples.barometer.size(), static_cast<std::size_t>(kSteps));
  EXPECT_EQ(samples.barometer[3].t_ns, 3 * kMeasuredEveryNs);
  EXPECT_NEAR(samples.barometer[3].pressure_pa, kPressurePa, 0.01);
  ASSERT_EQ(samples.airspeed.size(), static_cast<std::size_t>(kSteps));
  EXPECT_NEAR(samples.airspeed[3].indicated_airspeed_m_s, kAirspeedMS, 1e-5);
  EXPECT_NEAR(samples.airspeed[3].differential_pressure_pa, kDynamicPa, 1e-3);
}

inline void expect_fix(const std::vector<GpsSample>& samples, double alt_ellipsoid_m) {
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(kSteps));
  EXPECT_EQ(samples[0].fix, GpsFixType::k3d);
  EXPECT_EQ(samples[3].t_ns, 3 * kMeasuredEveryNs);
  EXPECT_NEAR(deg_from_rad(samples[3].place.lat_rad), 47.0 + 3 * kLatStepDeg, 1e-7);
  EXPECT_NEAR(deg_from_rad(samples[3].place.lon_rad), 8.0, 1e-7);
  EXPECT_NEAR(samples[3].place.alt_ellipsoid_m, alt_ellipsoid_m, 1e-3);
}

/// Flies the bytes of a log.
class LoggedFormats : public ::testing::Test {
 protected:
  [[nodiscard]] FlownSensors flown(const Bytes& bytes, const LogFlightOptions& options = {}) {
    const auto file = folder_.path() / ("flight" + std::to_string(files_++));
    write_bytes(file, bytes);
    return sensors_of(file, options);
  }
  overfly::testing::TemporaryFolder folder_;
  int files_ = 0;
};

}  // namespace overfly::flight::testing
