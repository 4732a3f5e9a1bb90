// Sensors against closed forms, published tables and the statistics that were asked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/time.hpp"
#include "flight/dynamics/environment.hpp"
#include "flight/sensors/air_sensors.hpp"
#include "flight/sensors/gps.hpp"
#include "flight/sensors/magnetometer.hpp"
#include "flight/sensors/range_finder.hpp"

namespace overfly::flight {
namespace {

constexpr std::int64_t k2026Ns = 1'767'225'600 * kNsPerS;

SensorPlace place_at(double lat_deg, double lon_deg, double alt_m) {
  return {LocalFrame(geodetic_from_deg(lat_deg, lon_deg, alt_m)),
          std::make_shared<FlatGround>(0.0),
          std::make_shared<MagneticField>(k2026Ns)};
}

AircraftState state_at(double up_m, const Eigen::Quaterniond& R_world_body) {
  AircraftState state;
  state.T_world_body.translation = {0.0, 0.0, up_m};
  state.T_world_body.rotation = R_world_body;
  state.airspeed_m_s = 25.0;
  return state;
}

double mean_value(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Autocovariance at a lag, about the mean 0.
double autocovariance(const std::vector<double>& values, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < values.size(); ++i) sum += values[i] * values[i - lag];
  return sum / static_cast<double>(values.size() - lag);
}

TEST(BarometerSensor, HasThePressuresOfTheStandardAtmosphere) {
  BarometerModel exact;
  exact.noise_pa = exact.drift_pa = exact.temperature_noise_k = exact.temperature_drift_k = 0.0;
  Barometer barometer(exact, 1);
  // U.S. Standard Atmosphere 1976, table I: geometric height [m], temperature [K], pressure [Pa].
  struct Row {
    double z_m, temperature_k, pressure_pa;
  };
  for (const Row& row : {Row{0.0, 288.150, 101325.0},
                         Row{1000.0, 281.651, 89876.3},
                         Row{3000.0, 268.659, 70121.2},
                         Row{5000.0, 255.676, 54048.3},
                         Row{12000.0, 216.650, 19399.4}}) {
    const SensorPlace place = place_at(40.0, -86.0, row.z_m);
    const BarometerSample sample =
        barometer.measure(state_at(0.0, Eigen::Quaterniond::Identity()), place);
    EXPECT_NEAR(sample.pressure_pa / row.pressure_pa, 1.0, 1e-5) << row.z_m;
    EXPECT_NEAR(sample.temperature_k, row.temperature_k, 1e-3) << row.z_m;
  }
}

TEST(BarometerSensor, HasTheNoiseAndTheDriftItWasAskedFor) {
  BarometerModel model;
  model.drift_time_s = 5.0;
  Barometer barometer(model, 3);
  const SensorPlace place = place_at(40.0, -86.0, 0.0);
  const AircraftState state = state_at(0.0, Eigen::Quaterniond::Identity());
  std::vector<double> error;
  for (int i = 0; i < 500'000; ++i) {  // 4000 times the drift's
    error.push_back(barometer.measure(state, place).pressure_pa - 101325.0);
  }
  // Without correlation the white part would be missing from every lag but 0.
  const double drift = autocovariance(error, 1) / std::exp(-0.04 / 5.0);
  EXPECT_NEAR(std::sqrt(drift) / model.drift_pa, 1.0, 0.05);
  EXPECT_NEAR(std::sqrt(autocovariance(error, 0) - drift) / model.noise_pa, 1.0, 0.2);
  EXPECT_NEAR(autocovariance(error, 125) / drift, std::exp(-1.0), 0.05);
}

TEST(AirspeedSensorTest, HasTheDynamicPressureOfTheAirspeed) {
  AirspeedModel exact;
  exact.noise_pa = exact.drift_pa = 0.0;
  AirspeedSensor sensor(exact, 1);
  const AircraftState state = state_at(0.0, Eigen::Quaterniond::Identity());
  const AirspeedSample at_sea = sensor.measure(state, place_at(40.0, -86.0, 0.0));
  EXPECT_NEAR(at_sea.differential_pressure_pa, 0.5 * 1.225 * 625.0, 0.01);
  EXPECT_NEAR(at_sea.indicated_airspeed_m_s, 25.0, 1e-3);
  // At 3000 m the density is 0.90925 kg/m^3 (U.S. Standard Atmosphere 1976, table I).
  const AirspeedSample aloft = sensor.measure(state, place_at(40.0, -86.0, 3000.0));
  EXPECT_NEAR(aloft.indicated_airspeed_m_s, 25.0 * std::sqrt(0.90925 / 1.225), 1e-3);
}

TEST(AirspeedSensorTest, KeepsTheSignOfItsErrorsAtRest) {
  AirspeedModel model;
  model.drift_pa = 0.0;
  AirspeedSensor sensor(model, 7);
  AircraftState state = state_at(0.0, Eigen::Quaterniond::Identity());
  state.airspeed_m_s = 0.0;
  const SensorPlace place = place_at(40.0, -86.0, 0.0);
  int negative = 0;
  for (int i = 0; i < 40000; ++i) {
    const AirspeedSample sample = sensor.measure(state, place);
    EXPECT_EQ(std::signbit(sample.indicated_airspeed_m_s),
              std::signbit(sample.differential_pressure_pa));
    if (sample.differential_pressure_pa < 0.0) ++negative;
  }
  EXPECT_GT(negative, 19000);
  EXPECT_LT(negative, 21000);
}

/// Errors of a receiver at rest, north, east, down [m].
std::array<std::vector<double>, 3> position_errors(Gps& gps, int samples) {
  const SensorPlace place = place_at(39.3, -86.0, 200.0);
  AircraftState state = state_at(100.0, Eigen::Quaterniond::Identity());
  state.T_world_body.translation.x() = 5000.0;
  const LocalFrame here(place.frame.geodetic_from_world(state.T_world_body.translation));
  std::array<std::vector<double>, 3> errors;
  for (int i = 0; i < samples; ++i) {
    state.t_ns = i * kNsPerS / 5;
    const Eigen::Vector3d enu = here.world_from_geodetic(gps.measure(state, place).place);
    errors[0].push_back(enu.y());
    errors[1].push_back(enu.x());
    errors[2].push_back(-enu.z());
  }
  return errors;
}

TEST(GpsSensor, HasTheErrorsOfItsModel) {
  GpsModel model;
  model.drift_time_s = 20.0;
  Gps gps(model, {}, 11);
  const auto errors = position_errors(gps, 400'000);  // 4000 times the drift's
  for (int axis = 0; axis < 3; ++axis) {
    const double drift_m = axis < 2 ? 4.7 : 9.2;
    const double noise_m = axis < 2 ? 0.4 : 0.7;
    const double drift = autocovariance(errors[axis], 1) / std::exp(-0.2 / 20.0);
    EXPECT_NEAR(std::sqrt(drift) / drift_m, 1.0, 0.05) << axis;
    EXPECT_NEAR(std::sqrt(autocovariance(errors[axis], 0) - drift) / noise_m, 1.0, 0.2) << axis;
    EXPECT_NEAR(autocovariance(errors[axis], 100) / drift, std::exp(-1.0), 0.06) << axis;
    EXPECT_NEAR(mean_value(errors[axis]), 0.0, 4.0 * drift_m * std::sqrt(2.0 / 4000.0)) << axis;
  }
}

TEST(GpsSensor, ByItsDefaultsIsThePublishedProcess) {
  // Beard and McLain 2012, section 7.5: increments of 0.21 m (north, east) and 0.40 m (altitude) a
  // second keep up standard deviations of 4.7 m and 9.2 m with a time constant of 1100 s.
  const GpsModel model;
  const double kept = std::exp(-1.0 / model.drift_time_s);
  EXPECT_NEAR(model.horizontal_drift_m * std::sqrt(1.0 - kept * kept), 0.21, 0.011);
  EXPECT_NEAR(model.vertical_drift_m * std::sqrt(1.0 - kept * kept), 0.40, 0.011);
}

TEST(GpsSensor, DeliversLateAndHasNoFixInAnOutage) {
  const SensorPlace place = place_at(39.3, -86.0, 200.0);
  AircraftState state = state_at(100.0, Eigen::Quaterniond::Identity());
  state.v_body_world_m_s = {3.0, 20.0, -1.0};
  GpsModel model;
  model.velocity_noise_m_s = 0.0;
  Gps with_outage(model, {{2 * kNsPerS, 3 * kNsPerS}}, 2);
  Gps without(model, {}, 2);
  int lost = 0;
  for (int i = 0; i < 50; ++i) {
    state.t_ns = i * kNsPerS / 5;
    const GpsSample sample = with_outage.measure(state, place);
    const GpsSample reference = without.measure(state, place);
    EXPECT_EQ(sample.t_ns, state.t_ns);
    EXPECT_EQ(sample.delivered_ns, state.t_ns + 100'000'000);
    if (state.t_ns >= 2 * kNsPerS && state.t_ns < 3 * kNsPerS) {
      ++lost;
      EXPECT_EQ(sample.fix, GpsFixType::kNone);
      EXPECT_TRUE(std::isnan(sample.place.lat_rad) && std::isnan(sample.velocity_ned_m_s.x()) &&
                  std::isnan(sample.horizontal_accuracy_m));
    } else {
      EXPECT_EQ(sample.fix, GpsFixType::k3d);
      EXPECT_EQ(sample.place.lat_rad, reference.place.lat_rad);
      EXPECT_LT((sample.velocity_ned_m_s - Eigen::Vector3d(20.0, 3.0, 1.0)).norm(), 1e-9);
    }
  }
  EXPECT_EQ(lost, 5);
}

TEST(MagnetometerSensor, TurnsTheEarthsFieldIntoTheBody) {
  MagnetometerModel exact;
  exact.noise_ut = exact.bias_ut = 0.0;
  Magnetometer sensor(exact, 1);
  const SensorPlace place = place_at(80.0, 0.0, 0.0);
  const Eigen::Vector3d ned = place.magnetic_field->ned_ut(place.frame.origin());
  // Level and to the north, body is north-east-down.
  const auto level_north = state_at(0.0, R_world_body_from({0.0, 0.0, 0.0}));
  EXPECT_LT((sensor.measure(level_north, place).field_ut - ned).norm(), 1e-9);
  const auto level_east = state_at(0.0, R_world_body_from({0.0, 0.0, kPi / 2.0}));
  EXPECT_LT(
      (sensor.measure(level_east, place).field_ut - Eigen::Vector3d(ned.y(), -ned.x(), ned.z()))
          .norm(),
      1e-9);
  const auto on_its_right_wing = state_at(0.0, R_world_body_from({kPi / 2.0, 0.0, 0.0}));
  EXPECT_LT((sensor.measure(on_its_right_wing, place).field_ut -
             Eigen::Vector3d(ned.x(), ned.z(), -ned.y()))
                .norm(),
            1e-9);
}

TEST(MagnetometerSensor, HasOneBiasForAFlight) {
  MagnetometerModel model;
  const SensorPlace place = place_at(40.0, -86.0, 0.0);
  const auto state = state_at(0.0, R_world_body_from({0.0, 0.0, 0.0}));
  const Eigen::Vector3d field = place.magnetic_field->ned_ut(place.frame.origin());
  std::vector<double> bias_x, noise_x;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Magnetometer sensor(model, seed);
    double sum = 0.0;
    for (int i = 0; i < 100; ++i) {
      const double error = sensor.measure(state, place).field_ut.x() - field.x();
      sum += error;
      noise_x.push_back(error);
    }
    bias_x.push_back(sum / 100.0);
    for (int i = 0; i < 100; ++i) noise_x[noise_x.size() - 100 + i] -= bias_x.back();
  }
  EXPECT_NEAR(std::sqrt(autocovariance(bias_x, 0)) / model.bias_ut, 1.0, 0.1);
  EXPECT_NEAR(std::sqrt(autocovariance(noise_x, 0)) / model.noise_ut, 1.0, 0.05);
}

TEST(RangeSensor, MeasuresAlongTheTiltedBeam) {
  RangeModel exact;
  exact.noise_m = 0.0;
  exact.max_m = 150.0;
  RangeFinder sensor(exact, 1);
  const FlatGround ground(20.0);
  for (const double roll_deg : {0.0, 20.0, -45.0, 60.0}) {
    for (const double pitch_deg : {0.0, 10.0, -30.0}) {
      const double roll = roll_deg * kPi / 180.0, pitch = pitch_deg * kPi / 180.0;
      const auto state = state_at(80.0, R_world_body_from({roll, pitch, 1.0}));
      const double range_m = 60.0 / (std::cos(roll) * std::cos(pitch));
      EXPECT_NEAR(sensor.measure(state, ground).range_m, range_m, 1e-3);
    }
  }
  const auto infinite = [&](double up_m, double roll) {
    return std::isinf(
        sensor.measure(state_at(up_m, R_world_body_from({roll, 0.0, 0.0})), ground).range_m);
  };
  EXPECT_FALSE(infinite(20.0 + 149.9, 0.0));
  EXPECT_TRUE(infinite(20.0 + 150.1, 0.0));
  EXPECT_TRUE(infinite(80.0, 1.5)) << "the beam meets the ground at 848 m";
  EXPECT_TRUE(infinite(80.0, kPi)) << "upside down";
  EXPECT_TRUE(infinite(20.15, 0.0)) << "nearer than min_m";
}

/// A plane through the origin that rises to the east.
class RisingPlane final : public HeightQuery {
 public:
  explicit RisingPlane(double rise) : rise_(rise) {}
  [[nodiscard]] double ground_up_m(double east_m, double /*north_m*/) const override {
    return rise_ * east_m;
  }

 private:
  double rise_;
};

TEST(RangeSensor, LooksAlongAGrazingBeamInBoundedTime) {
  /// Flat ground that counts how often it is asked.
  class CountedGround final : public HeightQuery {
   public:
    [[nodiscard]] double ground_up_m(double /*east_m*/, double /*north_m*/) const override {
      ++asked;
      return 0.0;
    }
    mutable int asked = 0;
  } ground;
  // 3 m above the ground, along it.
  EXPECT_FALSE(beam_range_m(ground, {0.0, 0.0, 3.0}, {1.0, 0.0, 0.0}, 100'000.0));
  EXPECT_LT(ground.asked, 1600);
  // It still finds where a flat beam meets the ground.
  const Eigen::Vector3d beam = Eigen::Vector3d(1.0, 0.0, -0.001).normalized();
  const auto found = beam_range_m(ground, {0.0, 0.0, 3.0}, beam, 100'000.0);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 3.0 / -beam.z(), 0.01);
}

TEST(RangeSensor, FindsTheNearestGroundOfASlope) {
  const RisingPlane slope(0.5);
  for (const double east : {-0.9, -0.3, 0.0, 0.4, 0.8}) {
    const Eigen::Vector3d beam = Eigen::Vector3d(east, 0.1, -0.6).normalized();
    // 100 + s z = 0.5 s x
    const double range_m = 100.0 / (0.5 * beam.x() - beam.z());
    const auto found = beam_range_m(slope, {0.0, 0.0, 100.0}, beam, 1000.0);
    ASSERT_TRUE(found) << east;
    EXPECT_NEAR(*found, range_m, 1e-4) << east;
  }
  EXPECT_FALSE(beam_range_m(slope, {0.0, 0.0, 100.0}, {0.0, 0.0, 1.0}, 1000.0));
  EXPECT_EQ(beam_range_m(slope, {0.0, 0.0, -1.0}, {0.0, 0.0, -1.0}, 1000.0), 0.0) << "below it";
}

}  // namespace
}  // namespace overfly::flight
