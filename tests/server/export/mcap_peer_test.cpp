// MCAP exports as the MCAP project's own reader sees them, with the messages decoded by an
// independent implementation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>

#include "core/motion/pose.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "tests/server/export/export_fixture.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// One document a line; empty if the peer is not installed.
std::vector<Json> mcap_peer_lines(const std::filesystem::path& file) {
  const auto script = overfly::testing::source_file("tests/server/export/mcap_peer/peer.cjs");
  if (!std::filesystem::exists(script.parent_path() / "node_modules" / "@mcap")) return {};
  std::FILE* const pipe =
      ::popen(("node '" + script.string() + "' '" + file.string() + "'").c_str(), "r");
  if (pipe == nullptr) return {};
  std::vector<Json> lines;
  std::string line;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c != '\n') {
      line += static_cast<char>(c);
      continue;
    }
    lines.push_back(Json::parse(line));
    line.clear();
  }
  ::pclose(pipe);
  return lines;
}

TEST(McapPeer, ReadsEveryMessageOfAnExport) {
  const overfly::testing::TemporaryFolder folder;
  const ExportSource source = testing::small_source(
      {R"(camera.distortion={"model":"radtan","coefficients":[-0.1,0.01,0.002,0.001]})"});
  const auto options = testing::export_options(folder.path() / "d", DatasetFormat::kMcap);
  testing::exported(source, options);
  const std::vector<Json> lines = mcap_peer_lines(options.folder / "flight.mcap");
  if (lines.empty()) {
    GTEST_SKIP() << "@mcap/core is not installed: npm ci --prefix tests/server/export/mcap_peer";
  }
  ASSERT_FALSE(lines.back().contains("error")) << lines.back();
  const std::vector<MadeFrame> frames = testing::frames_of(source.scenario);
  const std::size_t messages = 5 * frames.size();
  EXPECT_EQ(lines.back().at("profile"), "ros2");
  for (const char* count : {"indexed", "streamed", "stated"}) {
    EXPECT_EQ(lines.back().at(count), messages) << count;
  }
  EXPECT_EQ(lines.back().at("ended"), true);
  ASSERT_EQ(lines.size(), messages + 1);
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < messages; ++i) {
    const Json& line = lines[i];
    const std::string topic = line.at("topic");
    if (topic == "/tf" && line.at("child") == "base_link") {
      EXPECT_EQ(line.at("frame_id"), "camera_optical_frame");
      continue;
    }
    const MadeFrame& frame = frames.at(seen[topic]++);
    const CameraShot& shot = frame.shots[0];
    const std::int64_t t_ns = source.epoch_utc_ns + frame.t_ns;
    EXPECT_EQ(line.at("log_ns"), std::to_string(t_ns));
    EXPECT_EQ(line.at("stamp"), Json({t_ns / kNsPerS, t_ns % kNsPerS}));
    const Eigen::Vector3d& p = shot.drawn.T_world_camera.translation;
    const Eigen::Vector4d q = shot.drawn.T_world_camera.rotation.coeffs();
    if (topic == "/camera/truth") {
      EXPECT_EQ(line.at("frame_id"), "world");
      EXPECT_EQ(line.at("p"), Json({p.x(), p.y(), p.z()}));
      EXPECT_EQ(line.at("q"), Json({q.x(), q.y(), q.z(), q.w()}));
    } else if (topic == "/tf") {
      EXPECT_EQ(line.at("child"), "camera_optical_frame");
      EXPECT_EQ(line.at("p"), Json({p.x(), p.y(), p.z()}));
    } else if (topic == "/camera/image_raw") {
      EXPECT_EQ(line.at("encoding"), "mono8");
      EXPECT_EQ(line.at("size"), Json({160, 120, 160}));
      EXPECT_EQ(line.at("bytes"), 160 * 120);
      EXPECT_EQ(line.at("sum"), std::accumulate(shot.image.data.begin(), shot.image.data.end(), 0));
    } else {
      EXPECT_EQ(topic, "/camera/camera_info");
      const PinholeCamera& camera = source.scenario.main_camera().model.pinhole();
      EXPECT_EQ(line.at("model"), "plumb_bob");
      EXPECT_EQ(line.at("d"), Json({-0.1, 0.01, 0.002, 0.001, 0.0}));
      EXPECT_EQ(
          line.at("k"),
          Json({camera.fx_px, 0.0, camera.cx_px, 0.0, camera.fy_px, camera.cy_px, 0.0, 0.0, 1.0}));
    }
  }
  for (const auto& [topic, count] : seen) EXPECT_EQ(count, frames.size()) << topic;
}

TEST(McapPeer, ReadsTheSamplesOfTheSensors) {
  const overfly::testing::TemporaryFolder folder;
  const RunOptions flying = testing::options_for(folder.path() / "run");
  const auto run = run_scenario(
      testing::small_scenario({R"(sensors={"imu":{},"barometer":{},"gps":{},"airspeed":{},
                                           "magnetometer":{},"range":{"max_m":1000}})",
                               R"(faults=[{"kind":"gps_outage","at_s":1,"duration_s":0.5}])"}),
      flying);
  ASSERT_TRUE(run.ok()) << run.error().message;
  const ExportSource source = open_export_source(folder.path() / "run").value();
  ExportOptions options = testing::export_options(folder.path() / "d", DatasetFormat::kMcap);
  options.renderer_factory = testing::noop_factory();
  testing::exported(source, options);
  const std::vector<Json> lines = mcap_peer_lines(options.folder / "flight.mcap");
  if (lines.empty()) {
    GTEST_SKIP() << "@mcap/core is not installed: npm ci --prefix tests/server/export/mcap_peer";
  }
  ASSERT_FALSE(lines.back().contains("error")) << lines.back();
  std::map<std::string, std::vector<Json>> topics;
  for (const Json& line : lines) {
    if (line.contains("value")) topics[line.at("topic")].push_back(line);
  }
  const SensorSamples recorded =
      SensorFilesReader::open(folder.path() / "run").value().until(2 * kNsPerS).value();
  const auto& imu = topics["/sensors/imu"];
  ASSERT_EQ(imu.size(), recorded.imu.size());
  const auto vector_of = [](const Json& value) {
    return Eigen::Vector3d(value.at("x"), value.at("y"), value.at("z"));
  };
  const Eigen::Vector3d kFlu(1.0, -1.0, -1.0);
  for (std::size_t i = 0; i < imu.size(); ++i) {
    const ImuSample& sample = recorded.imu[i];
    const std::int64_t t_ns = source.epoch_utc_ns + sample.t_ns;
    EXPECT_EQ(imu[i].at("stamp"), Json({t_ns / kNsPerS, t_ns % kNsPerS}));
    EXPECT_EQ(imu[i].at("frame_id"), "base_link");
    const Json& value = imu[i].at("value");
    EXPECT_EQ(vector_of(value.at("angular_velocity")),
              sample.angular_rate_rad_s.cwiseProduct(kFlu));
    EXPECT_EQ(vector_of(value.at("linear_acceleration")),
              sample.acceleration_m_s2.cwiseProduct(kFlu));
    EXPECT_EQ(value.at("orientation_covariance").at(0), -1.0);
  }
  const auto& fixes = topics["/sensors/gps/fix"];
  const auto& velocities = topics["/sensors/gps/velocity"];
  ASSERT_EQ(fixes.size(), recorded.gps.size());
  ASSERT_EQ(velocities.size(), recorded.gps.size());
  std::size_t outages = 0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    const GpsSample& sample = recorded.gps[i];
    const Json& value = fixes[i].at("value");
    EXPECT_EQ(fixes[i].at("log_ns"), std::to_string(source.epoch_utc_ns + sample.delivered_ns));
    if (sample.fix == GpsFixType::kNone) {
      ++outages;
      EXPECT_EQ(value.at("status").at("status"), -1);
      EXPECT_EQ(value.at("latitude"), "NaN");
      continue;
    }
    EXPECT_EQ(value.at("status").at("status"), 0);
    EXPECT_NEAR(value.at("latitude"), deg_from_rad(sample.place.lat_rad), 1e-12);
    EXPECT_EQ(value.at("altitude"), sample.place.alt_ellipsoid_m);
    EXPECT_NEAR(value.at("position_covariance").at(8),
                sample.vertical_accuracy_m * sample.vertical_accuracy_m,
                1e-9);
    EXPECT_EQ(vector_of(velocities[i].at("value").at("twist").at("linear")),
              Eigen::Vector3d(sample.velocity_ned_m_s.y(),
                              sample.velocity_ned_m_s.x(),
                              -sample.velocity_ned_m_s.z()));
  }
  EXPECT_GT(outages, 0U);
  ASSERT_EQ(topics["/sensors/pressure"].size(), recorded.barometer.size());
  ASSERT_EQ(topics["/sensors/temperature"].size(), recorded.barometer.size());
  for (std::size_t i = 0; i < recorded.barometer.size(); ++i) {
    EXPECT_EQ(topics["/sensors/pressure"][i].at("value").at("fluid_pressure"),
              recorded.barometer[i].pressure_pa);
    EXPECT_NEAR(topics["/sensors/temperature"][i].at("value").at("temperature"),
                recorded.barometer[i].temperature_k - 273.15,
                1e-9);
  }
  const auto& pitot = topics["/sensors/airspeed/differential_pressure"];
  ASSERT_EQ(pitot.size(), recorded.airspeed.size());
  EXPECT_EQ(pitot.back().at("value").at("fluid_pressure"),
            recorded.airspeed.back().differential_pressure_pa);
  const auto& fields = topics["/sensors/magnetic_field"];
  ASSERT_EQ(fields.size(), recorded.magnetometer.size());
  EXPECT_LT((1e6 * vector_of(fields.back().at("value").at("magnetic_field")) -
             recorded.magnetometer.back().field_ut.cwiseProduct(kFlu))
                .norm(),
            1e-9);
  const auto& ranges = topics["/sensors/range"];
  ASSERT_EQ(ranges.size(), recorded.range.size());
  EXPECT_EQ(ranges.back().at("value").at("range"),
            static_cast<double>(static_cast<float>(recorded.range.back().range_m)));
  EXPECT_EQ(ranges.back().at("value").at("max_range"), "Infinity");
}

}  // namespace
}  // namespace overfly::server
