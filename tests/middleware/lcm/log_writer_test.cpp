#include "middleware/lcm/log_writer.hpp"

#include <gmock/gmock.h>

#include <lcm/lcm-cpp.hpp>
#include <overfly_lcm/truth_t.hpp>

#include "middleware/lcm/messages.hpp"
#include "middleware/lcm/sensor_messages.hpp"
#include "tests/support/support.hpp"

namespace overfly::lcm {
namespace {

TEST(LcmLogWriter, WritesEventsThatLcmReadsBack) {
  const overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.lcm";
  const Image image(4, 2, 1, 9);
  constexpr std::int64_t kEpochNs = 1'700'000'000'000'000'000;
  {
    const auto writer = LogWriter::create(file, kEpochNs).value();
    ASSERT_TRUE(writer->write_calibration("C_", "belly", {}, 1'000).ok());
    ASSERT_TRUE(writer->write_image("C_", {3, 97'000'000, 5'000, image}).ok());
    ASSERT_TRUE(
        writer->write_truth("C_", {3, 96'000'000, 97'000'000, {{0.5, 0.5, -0.5, 0.5}, {1, 2, 3}}})
            .ok());
    ASSERT_TRUE(writer->finish().ok());
  }
  ::lcm::LogFile log(file.string(), "r");
  ASSERT_TRUE(log.good());
  std::vector<std::string> channels;
  overfly_lcm::truth_t truth{};
  std::int64_t last_us = 0;
  while (const ::lcm::LogEvent* event = log.readNextEvent()) {
    EXPECT_EQ(event->eventnum, static_cast<std::int64_t>(channels.size()));
    channels.push_back(event->channel);
    last_us = event->timestamp;
    if (event->channel == "C_TRUTH") {
      EXPECT_GT(truth.decode(event->data, 0, event->datalen), 0);
    }
  }
  EXPECT_THAT(channels, ::testing::ElementsAre("C_CALIBRATION", "C_IMAGE", "C_TIME", "C_TRUTH"));
  EXPECT_EQ(last_us, 1'700'000'000'097'000);
  EXPECT_EQ(truth.t_ns, 96'000'000);
  EXPECT_EQ(truth.stamp_ns, 97'000'000);
  EXPECT_EQ(truth.position[2], 3.0);
  // x y z w of the quaternion made of w x y z = 0.5 0.5 -0.5 0.5.
  EXPECT_THAT(truth.orientation, ::testing::ElementsAre(0.5, -0.5, 0.5, 0.5));
}

TEST(LcmLogWriter, WritesSamplesOfSensorsAtTheTimeOfTheirDelivery) {
  const overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.lcm";
  SensorSamples samples;
  samples.imu = {{5'000'000, {1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, {10'000'000, {}, {}}};
  samples.barometer = {{2'000'000, 98765.5, 281.25}};
  GpsSample fix;
  fix.t_ns = 1'000'000;
  fix.delivered_ns = 9'000'000;
  samples.gps = {fix};
  samples.airspeed = {{3'000'000, 350.5, 23.75}};
  samples.magnetometer = {{4'000'000, {19.5, -1.25, 48.0}}};
  samples.range = {{6'000'000, 55.5}};
  {
    const auto writer = LogWriter::create(file, 0).value();
    ASSERT_TRUE(writer->write_samples("C_", samples).ok());
    ASSERT_TRUE(writer->finish().ok());
  }
  ::lcm::LogFile log(file.string(), "r");
  ASSERT_TRUE(log.good());
  std::map<std::string, std::vector<std::int64_t>> times_us;
  while (const ::lcm::LogEvent* event = log.readNextEvent()) {
    times_us[event->channel].push_back(event->timestamp);
    const std::span bytes(static_cast<const std::uint8_t*>(event->data),
                          static_cast<std::size_t>(event->datalen));
    if (event->channel == "C_MAGNETOMETER") {
      const auto message = decode_message<overfly_lcm::magnetometer_t>(bytes).value();
      EXPECT_THAT(message.field_ut, ::testing::ElementsAre(19.5, -1.25, 48.0));
    }
    if (event->channel == "C_BAROMETER") {
      const auto message = decode_message<overfly_lcm::barometer_t>(bytes).value();
      EXPECT_EQ(message.pressure, 98765.5);
      EXPECT_EQ(message.temperature, 281.25);
    }
    if (event->channel == "C_AIRSPEED") {
      const auto message = decode_message<overfly_lcm::airspeed_t>(bytes).value();
      EXPECT_EQ(message.differential_pressure, 350.5);
      EXPECT_EQ(message.indicated_airspeed, 23.75);
    }
    if (event->channel == "C_RANGE") {
      EXPECT_EQ(decode_message<overfly_lcm::range_t>(bytes).value().range, 55.5);
    }
  }
  const std::map<std::string, std::vector<std::int64_t>> expected = {{"C_IMU", {5000, 10000}},
                                                                     {"C_BAROMETER", {2000}},
                                                                     {"C_GPS", {9000}},
                                                                     {"C_AIRSPEED", {3000}},
                                                                     {"C_MAGNETOMETER", {4000}},
                                                                     {"C_RANGE", {6000}}};
  EXPECT_EQ(times_us, expected);
}

TEST(LcmLogWriter, NamesTheFileThatCannotBeMade) {
  const overfly::testing::TemporaryFolder folder;
  const auto writer = LogWriter::create(folder.path() / "none" / "a.lcm", 0);
  ASSERT_FALSE(writer.ok());
  EXPECT_EQ(writer.error().code, ErrorCode::kIo);
  EXPECT_THAT(writer.error().message, ::testing::HasSubstr("none/a.lcm"));
}

/// Every byte that is written to /dev/full fails for want of space.
TEST(LcmLogWriter, SaysWhenTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const auto writer = LogWriter::create("/dev/full", 0).value();
  const Image image(64, 64, 1);
  Status status = writer->write_image("C_", {0, 0, 0, image});
  if (status) status = writer->finish();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_THAT(status.error().message, ::testing::HasSubstr("/dev/full"));
}

}  // namespace
}  // namespace overfly::lcm
