// The suite of sensors during a flight: times of the samples, and what one sensor does to others.
#include "flight/sensors/sensor_suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/time.hpp"

namespace overfly::flight {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kMillisecondNs = 1'000'000;

/// North at 20 m/s for some seconds; fails a test that goes back in time.
class StraightFlight final : public TruthSource {
 public:
  explicit StraightFlight(double end_s) : end_ns_(ns_from_s(end_s)) {}
  std::optional<std::int64_t> duration_ns() const override { return std::nullopt; }
  std::string description() const override { return "straight"; }

 private:
  Result<std::optional<AircraftState>> find_state(std::int64_t t_ns,
                                                  const std::atomic<bool>* /*cancel*/) override {
    EXPECT_GE(t_ns, last_ns_);
    last_ns_ = t_ns;
    if (t_ns > end_ns_) return std::optional<AircraftState>();
    AircraftState state;
    state.T_world_body.translation = {0.0, 20.0 * s_from_ns(t_ns), 50.0};
    state.T_world_body.rotation = R_world_body_from({0.0, 0.0, 0.0});
    state.v_body_world_m_s = {0.0, 20.0, 0.0};
    state.airspeed_m_s = 20.0;
    return std::optional(state);
  }

  std::int64_t end_ns_;
  std::int64_t last_ns_ = 0;
};

SensorSuite::Options options_with(const SensorModels& models) {
  return {models,
          {LocalFrame(geodetic_from_deg(39.3, -86.0, 200.0)),
           std::make_shared<FlatGround>(0.0),
           std::make_shared<MagneticField>(0)},
          9.80665,
          {},
          4};
}

SensorModels all_models() {
  return {
      ImuModel{}, BarometerModel{}, GpsModel{}, AirspeedModel{}, MagnetometerModel{}, RangeModel{}};
}

TEST(SensorSuite, SamplesComeWhenTheyAreAvailable) {
  SensorSuite suite(options_with(all_models()));
  const auto flight = sensed_while_flown(std::make_unique<StraightFlight>(10.0), suite);
  ASSERT_TRUE(flight->state_at(300 * kMillisecondNs).value());

  const SensorSamples first = suite.take_until(100 * kMillisecondNs);
  // Every 5 ms from 0; the sample of 100 ms ends at 102.5 ms.
  ASSERT_EQ(first.imu.size(), 20U);
  EXPECT_EQ(first.imu.front().t_ns, 0);
  EXPECT_EQ(first.imu.back().t_ns, 95 * kMillisecondNs);
  ASSERT_EQ(first.barometer.size(), 3U);
  EXPECT_EQ(first.barometer.back().t_ns, 80 * kMillisecondNs);
  ASSERT_EQ(first.gps.size(), 1U);
  EXPECT_EQ(first.gps[0].t_ns, 0);
  EXPECT_EQ(first.gps[0].delivered_ns, 100 * kMillisecondNs);
  EXPECT_EQ(first.airspeed.size(), 3U);
  EXPECT_EQ(first.magnetometer.size(), 6U);
  ASSERT_EQ(first.range.size(), 3U);
  EXPECT_NEAR(first.range[2].range_m, 50.0, 0.3);
  EXPECT_TRUE(suite.take_until(100 * kMillisecondNs).empty());

  const SensorSamples second = suite.take_until(300 * kMillisecondNs);
  EXPECT_EQ(second.imu.front().t_ns, 100 * kMillisecondNs);
  EXPECT_EQ(second.imu.back().t_ns, 295 * kMillisecondNs);
  ASSERT_EQ(second.gps.size(), 1U);
  EXPECT_EQ(second.gps[0].t_ns, 200 * kMillisecondNs);
}

TEST(SensorSuite, EndsWithTheFlight) {
  SensorSuite suite(options_with(all_models()));
  const auto flight = sensed_while_flown(std::make_unique<StraightFlight>(0.1), suite);
  EXPECT_FALSE(flight->state_at(kNsPerS).value());
  const SensorSamples samples = suite.take_until(kNsPerS);
  EXPECT_EQ(samples.imu.back().t_ns, 95 * kMillisecondNs);
  EXPECT_EQ(samples.range.back().t_ns, 100 * kMillisecondNs);
}

TEST(SensorSuite, OneSensorDoesNotChangeAnother) {
  SensorModels few;
  few.imu = ImuModel{};
  few.gps = GpsModel{};
  SensorSuite only_few(options_with(few));
  SensorSuite fitted(options_with(all_models()));
  const auto a = sensed_while_flown(std::make_unique<StraightFlight>(5.0), only_few);
  const auto b = sensed_while_flown(std::make_unique<StraightFlight>(5.0), fitted);
  // The suites are driven in steps of different lengths.
  for (int i = 0; i <= 50; ++i) ASSERT_TRUE(a->state_at(i * 100 * kMillisecondNs).value());
  ASSERT_TRUE(b->state_at(5 * kNsPerS).value());
  const SensorSamples few_samples = only_few.take_until(5 * kNsPerS);
  const SensorSamples all_samples = fitted.take_until(5 * kNsPerS);
  ASSERT_EQ(few_samples.imu.size(), 1000U);
  ASSERT_EQ(all_samples.imu.size(), 1000U);
  for (std::size_t i = 0; i < 1000; ++i) {
    ASSERT_EQ(few_samples.imu[i].acceleration_m_s2, all_samples.imu[i].acceleration_m_s2);
    ASSERT_EQ(few_samples.imu[i].angular_rate_rad_s, all_samples.imu[i].angular_rate_rad_s);
  }
  ASSERT_EQ(few_samples.gps.size(), all_samples.gps.size());
  EXPECT_EQ(few_samples.gps.back().place.lat_rad, all_samples.gps.back().place.lat_rad);
}

TEST(SensorModelsTest, RefuseWhatCannotBe) {
  SensorModels models = all_models();
  EXPECT_TRUE(models.validate());
  models.gps->delay_s = 11.0;
  ASSERT_FALSE(models.validate());
  EXPECT_EQ(models.validate().error().message, "gps.delay_s = 11: must be in [0, 10]");
  models = all_models();
  models.range->min_m = 120.0;
  EXPECT_THAT(models.validate().error().message, HasSubstr("range.min_m = 120"));
  models = all_models();
  models.barometer->noise_pa = std::nan("");
  EXPECT_THAT(models.validate().error().message, HasSubstr("barometer.noise_pa = nan"));
  models = all_models();
  models.magnetometer->rate_hz = 0.0;
  EXPECT_THAT(models.validate().error().message, HasSubstr("magnetometer.rate_hz = 0"));
  models = all_models();
  models.airspeed->drift_time_s = 0.0;
  EXPECT_THAT(models.validate().error().message, HasSubstr("airspeed.drift_time_s = 0"));
}

}  // namespace
}  // namespace overfly::flight
