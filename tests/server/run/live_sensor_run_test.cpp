// Runs that record the sensors of a live vehicle: the built-in one, over the loopback interface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <thread>

#include "core/outside/file_text.hpp"
#include "flight/dynamics/airframe_file.hpp"
#include "flight/dynamics/builtin_airframes.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/payload.hpp"
#include "flight/vehicle/serve_vehicle.hpp"
#include "server/export/dataset_export.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "server/run/run.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using flight::mavlink::PayloadReader;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;
using testing::options_for;
using testing::small_scenario;

/// `overfly vehicle` on a port of the loopback interface, 20 times as fast as the wall clock.
class BuiltinVehicle {
 public:
  BuiltinVehicle() {
    vehicle::VehicleSetup setup;
    for (const dynamics::BuiltinAirframe& known : dynamics::builtin_airframes()) {
      if (known.name == "piper_cub_third") {
        setup.airframe = dynamics::parse_airframe(known.text, "piper_cub_third").value();
      }
    }
    setup.airspeed_m_s = 20.0;
    setup.home = geodetic_from_deg(39.355375, -86.030728, 227.7);
    vehicle_ = vehicle::SimulatedVehicle::create(setup).value();
    thread_ = std::thread([this] {
      (void)vehicle::serve_vehicle(
          *vehicle_,
          flight::mavlink::parse_link_address("tcp-listen:127.0.0.1:0", "link").value(),
          20.0,
          stop_,
          [this](const auto& opened) { port_ = opened.port; });
    });
    while (port_ == 0) std::this_thread::yield();
  }
  ~BuiltinVehicle() {
    stop_ = true;
    thread_.join();
  }
  [[nodiscard]] std::string link() const { return "tcp:127.0.0.1:" + std::to_string(port_.load()); }

 private:
  std::unique_ptr<vehicle::SimulatedVehicle> vehicle_;
  std::atomic<bool> stop_ = false;
  std::atomic<int> port_ = 0;
  std::thread thread_;
};

struct SentMessage {
  std::uint32_t id = 0;
  std::vector<std::uint8_t> payload;
  [[nodiscard]] PayloadReader read() const { return PayloadReader(payload); }
};

/// All messages of the vehicle in a recording, in their order.
std::vector<SentMessage> recorded_messages(const fs::path& run) {
  const std::string text = overfly::testing::read_text(run / "vehicle.tlog");
  std::span<const std::uint8_t> rest(reinterpret_cast<const std::uint8_t*>(text.data()),
                                     text.size());
  flight::mavlink::FrameFinder finder(8);
  std::vector<SentMessage> messages;
  while (true) {
    const auto found = finder.next(rest, true);
    if (!found.frame) return messages;
    rest = rest.subspan(found.consumed_bytes);
    messages.push_back(
        {found.frame->message_id, {found.frame->payload.begin(), found.frame->payload.end()}});
  }
}

SensorSamples recorded_samples_of(const fs::path& run) {
  return SensorFilesReader::open(run)
      .value()
      .until(std::numeric_limits<std::int64_t>::max())
      .value();
}

/// "... from 12.345 s of its clock" in the manifest [ns].
std::int64_t start_of_flight_ns(const fs::path& run) {
  const std::string manifest = overfly::testing::read_text(run / "manifest.json");
  const std::size_t at = manifest.find(") from ");
  EXPECT_NE(at, std::string::npos);
  return std::llround(std::stod(manifest.substr(at + 7)) * 1e9);
}

TEST(LiveSensorRun, RecordsWhatTheVehicleSent) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "r";
  {
    const BuiltinVehicle vehicle;
    const std::string mission =
        overfly::testing::source_file("scenarios/missions/airfield_pattern.waypoints").string();
    const auto flown = run_scenario(small_scenario({"flight.mavlink.link=" + vehicle.link(),
                                                    "flight.mavlink.sensor_rate_hz=50",
                                                    "flight.mavlink.mission_file=" + mission,
                                                    "flight.mavlink.arm_and_start=true",
                                                    "duration_s=20"}),
                                    options_for(run));
    ASSERT_TRUE(flown.ok()) << flown.error().message;
  }
  const std::int64_t start_ns = start_of_flight_ns(run);
  const SensorSamples recorded = recorded_samples_of(run);
  std::map<std::int64_t, PayloadReader> sent_by_ns;
  std::map<std::int64_t, PayloadReader> attitude_by_ns;
  const std::vector<SentMessage> messages = recorded_messages(run);
  for (const SentMessage& message : messages) {
    if (message.id == 105) {
      const auto time_us = message.read().at<std::uint64_t>(0);
      sent_by_ns.emplace(static_cast<std::int64_t>(time_us) * 1000 - start_ns, message.read());
    }
    if (message.id == 30) {
      const auto boot_ms = message.read().at<std::uint32_t>(0);
      attitude_by_ns.emplace(std::int64_t{boot_ms} * 1'000'000 - start_ns, message.read());
    }
  }
  // 20 s at 50 Hz, each as it was sent (in single precision).
  ASSERT_NEAR(static_cast<double>(recorded.imu.size()), 1000.0, 15.0);
  std::size_t with_attitude = 0;
  double largest_force = 0.0;
  for (const ImuSample& sample : recorded.imu) {
    const auto sent = sent_by_ns.find(sample.t_ns);
    ASSERT_NE(sent, sent_by_ns.end()) << sample.t_ns;
    for (int i = 0; i < 3; ++i) {
      const std::size_t at = 4 * static_cast<std::size_t>(i);
      EXPECT_EQ(sample.acceleration_m_s2[i], sent->second.at<float>(8 + at));
      EXPECT_EQ(sample.angular_rate_rad_s[i], sent->second.at<float>(20 + at));
    }
    largest_force = std::max(largest_force, sample.acceleration_m_s2.norm());
    // The same rates in another message.
    const auto attitude = attitude_by_ns.find(sample.t_ns);
    if (attitude == attitude_by_ns.end()) continue;
    ++with_attitude;
    EXPECT_EQ(sample.angular_rate_rad_s.x(), attitude->second.at<float>(16));
    EXPECT_EQ(sample.angular_rate_rad_s.z(), attitude->second.at<float>(24));
  }
  EXPECT_GT(with_attitude, 400U);
  EXPECT_GT(largest_force, 10.0);  // it took off
  ASSERT_EQ(recorded.magnetometer.size(), recorded.imu.size());
  for (const MagnetometerSample& sample : recorded.magnetometer) {
    EXPECT_NEAR(sample.field_ut.norm(), 52.0, 2.0);  // of the earth in Indiana
  }
  EXPECT_EQ(recorded.barometer.size(), recorded.imu.size());
  // 227.7 m above sea level in the standard atmosphere of 1976.
  EXPECT_NEAR(recorded.barometer.front().pressure_pa, 98615.0, 15.0);
  EXPECT_NEAR(static_cast<double>(recorded.airspeed.size()), 400.0, 10.0);
  EXPECT_NEAR(static_cast<double>(recorded.gps.size()), 200.0, 5.0);
  EXPECT_NEAR(deg_from_rad(recorded.gps.front().place.lat_rad), 39.355375, 1e-3);
  EXPECT_NEAR(static_cast<double>(recorded.range.size()), 400.0, 10.0);
  const std::string log = overfly::testing::read_text(run / "log.jsonl");
  EXPECT_THAT(log, HasSubstr("sensors of the vehicle: imu from HIGHRES_IMU (50.0 Hz)"));
}

TEST(LiveSensorRun, AnExportHasTheVehiclesImu) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "r";
  {
    const BuiltinVehicle vehicle;
    const auto flown = run_scenario(small_scenario({"flight.mavlink.link=" + vehicle.link(),
                                                    "flight.mavlink.sensor_rate_hz=100"}),
                                    options_for(run));
    ASSERT_TRUE(flown.ok()) << flown.error().message;
  }
  const SensorSamples recorded = recorded_samples_of(run);
  ASSERT_GT(recorded.imu.size(), 190U);
  for (const ImuSample& sample : recorded.imu) {
    // It stands level: gravity upwards.
    EXPECT_LT((sample.acceleration_m_s2 - Eigen::Vector3d(0, 0, -9.80665)).norm(), 1e-6);
  }
  ExportOptions options;
  options.folder = folder.path() / "d";
  options.format = DatasetFormat::kEuroc;
  options.renderer_factory = testing::noop_factory();
  const auto exported = export_dataset(open_export_source(run).value(), options);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  const fs::path imu = options.folder / "mav0" / "imu0";
  EXPECT_THAT(overfly::testing::read_text(imu / "sensor.yaml"), HasSubstr("comment: recorded"));
  const std::string rows = overfly::testing::read_text(imu / "data.csv");
  EXPECT_EQ(static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n')) - 1,
            recorded.imu.size());
}

TEST(LiveSensorRun, SimulatedSensorsReplaceTheVehicles) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "r";
  {
    const BuiltinVehicle vehicle;
    const auto flown = run_scenario(small_scenario({"flight.mavlink.link=" + vehicle.link(),
                                                    "flight.mavlink.sensor_rate_hz=100",
                                                    R"(sensors={"imu":{"rate_hz":40}})"}),
                                    options_for(run));
    ASSERT_TRUE(flown.ok()) << flown.error().message;
  }
  const SensorSamples recorded = recorded_samples_of(run);
  EXPECT_NEAR(static_cast<double>(recorded.imu.size()), 84.0, 2.0);
  EXPECT_FALSE(recorded.barometer.empty());
}

}  // namespace
}  // namespace overfly::server
