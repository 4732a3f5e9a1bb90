// The sensors in flight logs: records made by hand, and two logs of one simulated flight.
#include "flight/replay/logged_sensors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/time.hpp"
#include "flight/logs/flight_log.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/logs/northward_log.hpp"
#include "tests/flight/replay/flown_sensors.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight {
namespace {

using testing::append;
using testing::Bytes;
using testing::FlownSensors;
using ::testing::HasSubstr;
using testing::put;
using testing::sensors_of;

/// A DataFlash record of a type at a time of 1.0 s + 40 ms * i.
Bytes record_at(std::uint8_t type, int i) {
  Bytes record = testing::record_header(type);
  put(record, static_cast<std::uint64_t>(1'000'000 + 40'000 * i));
  return record;
}

/// The flight of northward_log(), with a record of each sensor every 40 ms.
std::string log_with_sensors() {
  const std::string flown = overfly::testing::northward_log();
  Bytes bytes(flown.begin(), flown.end());
  const auto declare = [&](std::uint8_t type,
                           std::uint8_t size,
                           const char* name,
                           const char* letters,
                           const char* labels) {
    append(bytes, testing::format_record(type, size, name, letters, labels));
  };
  declare(10, 35, "IMU2", "Qffffff", "TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ");
  declare(11, 35, "IMU", "Qffffff", "TimeUS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ");
  declare(12, 17, "BARO", "Qfc", "TimeUS,Press,Temp");
  declare(13, 17, "MAG", "Qhhh", "TimeUS,MagX,MagY,MagZ");
  declare(14, 19, "ARSP", "Qff", "TimeUS,Airspeed,DiffPress");
  declare(15, 15, "RFND", "QCBB", "TimeUS,Dist,Stat,Orient");
  declare(16, 36, "GPS", "QBLLffff", "TimeUS,Status,Lat,Lng,Alt,Spd,GCrs,VZ");
  for (int i = 0; i < 50; ++i) {
    for (const std::uint8_t type : {10, 11}) {
      Bytes imu = record_at(type, i);
      for (const float value : {0.1F, 0.2F, 0.3F, 1.0F * type, 0.5F, -9.5F}) put(imu, value);
      append(bytes, imu);
    }
    Bytes baro = record_at(12, i);
    put(baro, 95000.0F);
    put(baro, std::int16_t{1550});
    append(bytes, baro);
    Bytes mag = record_at(13, i);
    for (const std::int16_t value : {200, -20, 450}) put(mag, value);
    append(bytes, mag);
    Bytes airspeed = record_at(14, i);
    for (const float value : {25.0F, 390.0F}) put(airspeed, value);
    append(bytes, airspeed);
    Bytes range = record_at(15, i);
    put(range, std::uint16_t{4321});
    range.push_back(i < 10 ? 4 : i < 20 ? 3 : 1);  // good, out of range, no data
    range.push_back(25);
    append(bytes, range);
    Bytes gps = record_at(16, i);
    gps.push_back(i == 0 ? 1 : 3);
    put(gps, std::int32_t{470000000});
    put(gps, std::int32_t{80000000});
    for (const float value : {500.0F, 25.0F, 90.0F, -1.5F}) put(gps, value);
    append(bytes, gps);
  }
  return {bytes.begin(), bytes.end()};
}

class LoggedSensors : public ::testing::Test {
 protected:
  void SetUp() override { overfly::testing::write_text(file(), log_with_sensors()); }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "flight.bin"; }
  overfly::testing::TemporaryFolder folder_;
};

TEST_F(LoggedSensors, OfDataFlashAreInUnitsOfSamplesAtTheFlightsTime) {
  LogFlightOptions options;
  options.geoid_separation_m = 40.0;
  const FlownSensors flown = sensors_of(file(), options);
  ASSERT_TRUE(flown.flight);
  EXPECT_EQ(flown.flight->log_start_ns(), kNsPerS);
  ASSERT_EQ(flown.samples.imu.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(flown.samples.imu[i].t_ns, static_cast<std::int64_t>(i) * 40'000'000);
    // Of the first IMU, not of the second.
    EXPECT_EQ(flown.samples.imu[i].acceleration_m_s2, Eigen::Vector3d(11.0, 0.5, -9.5));
    EXPECT_NEAR(flown.samples.imu[i].angular_rate_rad_s.z(), 0.3, 1e-7);
  }
  ASSERT_EQ(flown.samples.barometer.size(), 50U);
  EXPECT_EQ(flown.samples.barometer[7].pressure_pa, 95000.0);
  EXPECT_NEAR(flown.samples.barometer[7].temperature_k, 288.65, 1e-9);
  EXPECT_LT((flown.samples.magnetometer.at(3).field_ut - Eigen::Vector3d(20, -2, 45)).norm(), 1e-9);
  EXPECT_EQ(flown.samples.airspeed.at(3).indicated_airspeed_m_s, 25.0);
  EXPECT_EQ(flown.samples.airspeed.at(3).differential_pressure_pa, 390.0);
  ASSERT_EQ(flown.samples.range.size(), 20U);
  EXPECT_NEAR(flown.samples.range[9].range_m, 43.21, 1e-9);
  EXPECT_TRUE(std::isinf(flown.samples.range[10].range_m));
  ASSERT_EQ(flown.samples.gps.size(), 50U);
  EXPECT_EQ(flown.samples.gps[0].fix, GpsFixType::kNone);
  const GpsSample& gps = flown.samples.gps[1];
  EXPECT_NEAR(deg_from_rad(gps.place.lat_rad), 47.0, 1e-9);
  EXPECT_NEAR(gps.place.alt_ellipsoid_m, 540.0, 1e-9);
  EXPECT_LT((gps.velocity_ned_m_s - Eigen::Vector3d(0.0, 25.0, -1.5)).norm(), 1e-9);
  EXPECT_TRUE(std::isnan(gps.horizontal_accuracy_m));
  EXPECT_THAT(flown.report, HasSubstr("sensors of the log: imu from IMU (25.0 Hz), barometer"));
}

TEST_F(LoggedSensors, OfASliceAndOfAMovedFlight) {
  LogFlightOptions options;
  options.from_s = 1.4;
  options.to_s = 2.0;
  options.rebase.emplace().at = PlaceInWorld{};
  const FlownSensors flown = sensors_of(file(), options);
  ASSERT_FALSE(flown.samples.imu.empty());
  EXPECT_EQ(flown.samples.imu.front().t_ns, 0);
  EXPECT_TRUE(flown.samples.gps.empty());
  EXPECT_TRUE(flown.samples.magnetometer.empty());
  // Heights of the old place would be wrong without a word.
  EXPECT_TRUE(flown.samples.barometer.empty());
  EXPECT_TRUE(flown.samples.range.empty());
  EXPECT_FALSE(flown.samples.airspeed.empty());
  EXPECT_THAT(flown.report,
              HasSubstr("; not given: barometer, gps, magnetometer, range; logged, but left out "
                        "because the flight is moved: barometer, gps, magnetometer, range"));
}

/// Continues a log with another run of the clock from 0.1 s on: 60 positions, 60 samples of the IMU
/// and a mode, which are fewer messages than those before, but more positions.
std::string restarted(const std::string& before) {
  Bytes bytes(before.begin(), before.end());
  for (int i = 0; i < 60; ++i) {
    const auto t_us = static_cast<std::uint64_t>(100'000 + 40'000 * i);
    Bytes position = testing::record_header(2);
    put(position, t_us);
    put(position, 470000000 + 90 * i);
    put(position, std::int32_t{80000000});
    put(position, 500.0F);
    for (const std::int16_t angle : {1000, 0, 0}) put(position, angle);
    append(bytes, position);
    Bytes imu = testing::record_header(11);
    put(imu, t_us);
    for (const float value : {0.0F, 0.0F, 0.0F, 0.0F, 0.0F, -7.0F}) put(imu, value);
    append(bytes, imu);
    if (i != 10) continue;
    Bytes mode = testing::record_header(3);
    put(mode, t_us);
    for (const int value : {11, 11, 1}) mode.push_back(static_cast<std::uint8_t>(value));
    append(bytes, mode);
  }
  return {bytes.begin(), bytes.end()};
}

TEST_F(LoggedSensors, AndModesAreOfTheRunOfTheClockWhosePositionsAreFlown) {
  overfly::testing::write_text(file(), restarted(log_with_sensors()));
  const FlownSensors flown = sensors_of(file());
  ASSERT_TRUE(flown.flight);
  const std::int64_t start_ns = flown.flight->log_start_ns().value();
  EXPECT_LT(start_ns, kNsPerS);
  EXPECT_GT(flown.samples.imu.size(), 50U);
  for (const ImuSample& sample : flown.samples.imu) {
    EXPECT_EQ(sample.acceleration_m_s2.z(), -7.0) << sample.t_ns;
  }
  EXPECT_TRUE(flown.samples.gps.empty());
  const std::vector<FlightEvent> modes = flown.flight->take_events(100 * kNsPerS);
  ASSERT_EQ(modes.size(), 1U);
  EXPECT_EQ(modes[0].t_ns, 500'000'000 - start_ns);
}

/// A value of the samples of a list, interpolated linearly at a time; empty outside.
template <typename Sample, typename Value>
std::optional<Eigen::Vector3d> value_at(const std::vector<Sample>& list,
                                        std::int64_t t_ns,
                                        const Value& value) {
  const auto after =
      std::lower_bound(list.begin(), list.end(), t_ns, [](const Sample& sample, std::int64_t t) {
        return sample.t_ns < t;
      });
  if (after == list.begin() || after == list.end()) return std::nullopt;
  const Sample& a = *std::prev(after);
  const double part = s_from_ns(t_ns - a.t_ns) / s_from_ns(after->t_ns - a.t_ns);
  return (1.0 - part) * value(a) + part * value(*after);
}

struct Apart {
  int compared = 0;
  double rms = 0.0;
  double rms_of_values = 0.0;
};

/// The samples of one list against those of another.
template <typename Sample, typename Value>
Apart apart(const std::vector<Sample>& from,
            const std::vector<Sample>& to,
            std::int64_t shift_ns,
            const Value& value) {
  Apart found;
  for (const Sample& sample : from) {
    const auto other = value_at(to, sample.t_ns + shift_ns, value);
    if (!other) continue;
    ++found.compared;
    found.rms += (value(sample) - *other).squaredNorm();
    found.rms_of_values += other->squaredNorm();
  }
  found.rms = std::sqrt(found.rms / found.compared);
  found.rms_of_values = std::sqrt(found.rms_of_values / found.compared);
  return found;
}

TEST(RecordedSensors, AreTheSameInBothLogsOfAFlight) {
  OVERFLY_DATA_OR_SKIP(tlog_file, "sitl/plane25.tlog");
  OVERFLY_DATA_OR_SKIP(bin_file, "sitl/plane25.BIN");
  const FlownSensors sent = sensors_of(tlog_file);
  const FlownSensors logged = sensors_of(bin_file);
  std::printf("[ SENSORS ] %s\n[ SENSORS ] %s\n", sent.report.c_str(), logged.report.c_str());
  ASSERT_TRUE(sent.flight && logged.flight);
  const std::int64_t shift_ns =
      sent.flight->log_start_ns().value() - logged.flight->log_start_ns().value();
  const auto compare = [&](const char* what, const auto& list, const auto& value) {
    const Apart found = apart(sent.samples.*list, logged.samples.*list, shift_ns, value);
    std::printf("[ SENSORS ] %s: %d compared, %.4f RMS apart, %.4f RMS\n",
                what,
                found.compared,
                found.rms,
                found.rms_of_values);
    EXPECT_GT(found.compared, 400) << what;
    return found;
  };
  const Apart pressure =
      compare("pressure [Pa]", &SensorSamples::barometer, [](const BarometerSample& sample) {
        return Eigen::Vector3d(sample.pressure_pa, 0.0, 0.0);
      });
  EXPECT_LT(pressure.rms, 2.0);
  const Apart rate = compare("rate [rad/s]", &SensorSamples::imu, [](const ImuSample& sample) {
    return sample.angular_rate_rad_s;
  });
  EXPECT_LT(rate.rms, 0.2 * rate.rms_of_values);
  const Apart force = compare("force [m/s^2]", &SensorSamples::imu, [](const ImuSample& sample) {
    return sample.acceleration_m_s2;
  });
  EXPECT_LT(force.rms, 0.1 * force.rms_of_values);
  const Apart field = compare("field [uT]",
                              &SensorSamples::magnetometer,
                              [](const MagnetometerSample& sample) { return sample.field_ut; });
  EXPECT_LT(field.rms, 0.1 * field.rms_of_values);
  const Apart velocity = compare("GPS [m/s]", &SensorSamples::gps, [](const GpsSample& sample) {
    const bool known = sample.fix == GpsFixType::k3d;
    return known ? Eigen::Vector3d(sample.velocity_ned_m_s.x(), sample.velocity_ned_m_s.y(), 0.0)
                 : Eigen::Vector3d(0.0, 0.0, 0.0);
  });
  EXPECT_LT(velocity.rms, 0.2 * velocity.rms_of_values);
  const Apart airspeed =
      compare("airspeed [m/s]", &SensorSamples::airspeed, [](const AirspeedSample& sample) {
        return Eigen::Vector3d(sample.indicated_airspeed_m_s, 0.0, 0.0);
      });
  EXPECT_LT(airspeed.rms, 0.1 * airspeed.rms_of_values);
}

}  // namespace
}  // namespace overfly::flight
