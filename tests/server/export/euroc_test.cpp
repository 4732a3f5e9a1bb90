// EuRoC data sets: frames of reference, stamps, and an IMU that integrates to the flight.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "core/motion/trajectory_io.hpp"
#include "flight/gravity.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "server/record/run_folder.hpp"
#include "server/run/run.hpp"
#include "tests/server/export/export_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using testing::different_samples;
using ::testing::ElementsAre;
using testing::export_options;
using testing::exported;
using ::testing::HasSubstr;
using testing::numbers_behind;
using testing::read_picture;
using testing::rows_of;
using testing::small_source;

constexpr const char* kTwoCameras =
    R"(cameras=[{"name":"down","width_px":160,"height_px":120,"rate_hz":10},
                {"name":"tilted","width_px":96,"height_px":64,"rate_hz":10,"color":"rgb",
                 "distortion":{"model":"radtan","coefficients":[-0.1,0.01,0.002,0.001]},
                 "mount":{"pitch_deg":25,"p_body_m":[0.2,1,0]}}])";

/// State and IMU rows of an exported data set.
struct Sample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d p, v;
  Eigen::Quaterniond q;
  Eigen::Vector3d gyro_bias, accel_bias;
  Eigen::Vector3d rate, force;
};

Eigen::Vector3d vector_at(const std::vector<std::string>& row, std::size_t begin) {
  return {std::stod(row.at(begin)), std::stod(row.at(begin + 1)), std::stod(row.at(begin + 2))};
}

std::vector<Sample> samples_of(const fs::path& mav0) {
  const auto states = rows_of(mav0 / "state_groundtruth_estimate0" / "data.csv", ',');
  const auto readings = rows_of(mav0 / "imu0" / "data.csv", ',');
  for (const char* list : {"imu0/data.csv", "cam0/data.csv"}) {
    const std::string text = overfly::testing::read_text(mav0 / list);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'),
              std::count(text.begin(), text.end(), '\r'));
    EXPECT_TRUE(text.ends_with("\r\n")) << list;
  }
  EXPECT_EQ(states.size(), readings.size());
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < std::min(states.size(), readings.size()); ++i) {
    const auto& row = states[i];
    EXPECT_EQ(row.size(), 17U);
    EXPECT_EQ(readings[i].size(), 7U);
    EXPECT_EQ(row[0], readings[i][0]);
    Sample sample;
    sample.t_ns = std::stoll(row[0]);
    sample.p = vector_at(row, 1);
    sample.q = Eigen::Quaterniond(
        std::stod(row[4]), std::stod(row[5]), std::stod(row[6]), std::stod(row[7]));
    sample.v = vector_at(row, 8);
    sample.gyro_bias = vector_at(row, 11);
    sample.accel_bias = vector_at(row, 14);
    sample.rate = vector_at(readings[i], 1);
    sample.force = vector_at(readings[i], 4);
    samples.push_back(sample);
  }
  return samples;
}

Eigen::Quaterniond rotation_by(const Eigen::Vector3d& rotation) {
  const double angle = rotation.norm();
  if (angle < 1e-15) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation / angle));
}

/// Dead reckoning from the first state: the trapezoidal rule over readings without their biases.
void integrate(const std::vector<Sample>& samples,
               double gravity_m_s2,
               Eigen::Vector3d& p,
               Eigen::Vector3d& v,
               Eigen::Quaterniond& q) {
  p = samples.front().p;
  v = samples.front().v;
  q = samples.front().q;
  const Eigen::Vector3d down(0.0, 0.0, -gravity_m_s2);
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const Sample& now = samples[i];
    const Sample& then = samples[i + 1];
    const double dt_s = double(then.t_ns - now.t_ns) * 1e-9;
    const Eigen::Vector3d rate = 0.5 * (now.rate - now.gyro_bias + then.rate - then.gyro_bias);
    const Eigen::Quaterniond q_then = (q * rotation_by(rate * dt_s)).normalized();
    const Eigen::Vector3d a =
        0.5 * (q * (now.force - now.accel_bias) + q_then * (then.force - then.accel_bias)) + down;
    p += v * dt_s + 0.5 * a * dt_s * dt_s;
    v += a * dt_s;
    q = q_then;
  }
}

/// Second order in 5 ms: about f' T^2 / 12 per second, and twice integrated for the position.
void expect_to_end_with_the_truth(const std::vector<Sample>& samples, double gravity_m_s2) {
  Eigen::Vector3d p, v;
  Eigen::Quaterniond q;
  integrate(samples, gravity_m_s2, p, v, q);
  const Sample& last = samples.back();
  std::printf("[ IMU      ] after %.1f s: %.4f m, %.5f m/s, %.6f deg\n",
              double(last.t_ns - samples.front().t_ns) * 1e-9,
              (p - last.p).norm(),
              (v - last.v).norm(),
              deg_from_rad(q.angularDistance(last.q)));
  EXPECT_LT(q.angularDistance(last.q), 1e-4);
  EXPECT_LT((v - last.v).norm(), 0.01);
  EXPECT_LT((p - last.p).norm(), 0.1);
}

TEST(Euroc, IntegratedImuGivesTheFlightBack) {
  const TemporaryFolder folder;
  // The banked turn lies in these 12 s.
  ExportSource source = small_source({"duration_s=18", "flight.course.length_m=900"});
  ExportOptions options = export_options(folder.path() / "d", DatasetFormat::kEuroc);
  options.renderer_factory = testing::noop_factory();
  options.imu = flight::ImuModel::ideal(200.0);
  options.from_s = 6.0;
  exported(source, options);
  const auto samples = samples_of(folder.path() / "d" / "mav0");
  ASSERT_GT(samples.size(), 2400U);
  double largest_turn = 0.0;
  for (const Sample& sample : samples) {
    largest_turn = std::max(largest_turn, sample.rate.norm());
    // Its mean over the sample's interval; the exact one is at its middle.
    EXPECT_NEAR(sample.q.norm(), 1.0, 1e-12);
  }
  EXPECT_GT(largest_turn, 0.3) << "the flight does not turn";

  FrameMakerOptions making;
  making.renderer_factory = testing::noop_factory();
  const auto maker = FrameMaker::open(source.scenario, making);
  ASSERT_TRUE(maker.ok());
  const LocalFrame& frame = (*maker)->world().tiles->frame();
  const double gravity = flight::normal_gravity_m_s2(frame.geodetic_from_world(samples.front().p));
  expect_to_end_with_the_truth(samples, gravity);
}

/// A run through a banked turn, and its export.
fs::path flown_and_exported(const fs::path& folder, const std::string& sensors) {
  const auto run = run_scenario(
      testing::small_scenario({"duration_s=18", "flight.course.length_m=900", sensors}),
      testing::options_for(folder / "run"));
  EXPECT_TRUE(run.ok()) << run.error().message;
  ExportOptions options = export_options(folder / "d", DatasetFormat::kEuroc);
  options.renderer_factory = testing::noop_factory();
  options.from_s = 6.0;
  exported(open_export_source(folder / "run").value(), options);
  return folder / "d" / "mav0";
}

TEST(Euroc, HasTheSamplesThatTheRunsEstimatorsReceived) {
  const TemporaryFolder folder;
  const fs::path mav0 = flown_and_exported(folder.path(), R"(sensors={"imu":{}})");
  const auto samples = samples_of(mav0);
  const SensorSamples received =
      SensorFilesReader::open(folder.path() / "run").value().until(20 * kNsPerS).value();
  ASSERT_GT(samples.size(), 2400U);
  const std::int64_t epoch_ns = open_export_source(folder.path() / "run").value().epoch_utc_ns;
  const auto first = static_cast<std::size_t>((samples[0].t_ns - epoch_ns) / 5'000'000);
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(samples[i].t_ns - epoch_ns, received.imu[first + i].t_ns);
    ASSERT_EQ(samples[i].rate, received.imu[first + i].angular_rate_rad_s);
    ASSERT_EQ(samples[i].force, received.imu[first + i].acceleration_m_s2);
    gyro_bias = samples[i].gyro_bias;
  }
  EXPECT_GT(gyro_bias.norm(), 1e-6);
  const std::string yaml = read_text(mav0 / "imu0" / "sensor.yaml");
  EXPECT_THAT(yaml, HasSubstr("gyroscope_noise_density: 0.00016968"));
}

/// What an estimator with an IMU does first: dead reckoning from the ground truth's first state.
TEST(Euroc, IntegratedSamplesOfAnIdealImuOfARunGiveTheFlightBack) {
  const TemporaryFolder folder;
  const fs::path mav0 = flown_and_exported(
      folder.path(),
      R"(sensors={"imu":{"gyroscope_noise_rad_s_sqrt_hz":0,"gyroscope_walk_rad_s2_sqrt_hz":0,)"
      R"("accelerometer_noise_m_s2_sqrt_hz":0,"accelerometer_walk_m_s3_sqrt_hz":0}})");
  const auto samples = samples_of(mav0);
  ASSERT_GT(samples.size(), 2400U);
  const auto manifest = read_json(manifest_file(folder.path() / "run")).value();
  const auto& origin = manifest.at("world").at("origin");
  const double gravity = flight::normal_gravity_m_s2(
      geodetic_from_deg(origin.at("lat_deg"), origin.at("lon_deg"), origin.at("alt_ellipsoid_m")));
  expect_to_end_with_the_truth(samples, gravity);
}

TEST(Euroc, AScenarioMeasuresWhatARunOfItMeasures) {
  const TemporaryFolder folder;
  const std::string sensors = R"(sensors={"imu":{}})";
  const fs::path of_run = flown_and_exported(folder.path(), sensors);
  ExportOptions options = export_options(folder.path() / "s", DatasetFormat::kEuroc);
  options.renderer_factory = testing::noop_factory();
  options.from_s = 6.0;
  const ExportSource source =
      small_source({"duration_s=18", "flight.course.length_m=900", sensors});
  exported(source, options);
  const auto recorded = samples_of(of_run);
  const auto measured = samples_of(options.folder / "mav0");
  ASSERT_GE(measured.size(), recorded.size());
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    ASSERT_EQ(measured[i].rate, recorded[i].rate) << i;
    ASSERT_EQ(measured[i].force, recorded[i].force) << i;
    ASSERT_EQ(measured[i].accel_bias, recorded[i].accel_bias) << i;
  }
  options.folder = folder.path() / "refused";
  options.imu = flight::ImuModel::ideal();
  const auto refused = export_dataset(source, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(refused.error().message, HasSubstr("imu: must not be given"));
}

TEST(Euroc, NoiseDensitiesAreThoseAskedForAndBiasesAreInTheTruth) {
  const TemporaryFolder folder;
  ExportOptions options = export_options(folder.path() / "noisy", DatasetFormat::kEuroc);
  options.renderer_factory = testing::noop_factory();
  options.imu.emplace();
  options.imu->rate_hz = 100.0;
  options.imu->gyroscope_noise_rad_s_sqrt_hz = 2e-3;
  options.imu->gyroscope_walk_rad_s2_sqrt_hz = 1e-3;
  options.imu->accelerometer_walk_m_s3_sqrt_hz = 2e-4;
  const ExportSource source = small_source({"duration_s=20"});
  exported(source, options);
  ExportOptions exact = export_options(folder.path() / "exact", DatasetFormat::kEuroc);
  exact.renderer_factory = testing::noop_factory();
  exact.imu = flight::ImuModel::ideal(100.0);
  exported(source, exact);
  const auto noisy = samples_of(folder.path() / "noisy" / "mav0");
  const auto clean = samples_of(folder.path() / "exact" / "mav0");
  ASSERT_EQ(noisy.size(), clean.size());
  double white = 0.0, walk = 0.0;
  for (std::size_t i = 1; i < noisy.size(); ++i) {
    white += (noisy[i].rate - noisy[i].gyro_bias - clean[i].rate).squaredNorm() / 3.0;
    walk += (noisy[i].gyro_bias - noisy[i - 1].gyro_bias).squaredNorm() / 3.0;
    EXPECT_EQ(clean[i].gyro_bias.norm(), 0.0);
  }
  const double count = double(noisy.size() - 1);
  // sigma = density sqrt(rate); the walk grows by density / sqrt(rate). 3 x 2000 samples: the
  // estimate of a deviation scatters by 1 %.
  EXPECT_NEAR(std::sqrt(white / count), 2e-3 * 10.0, 0.05 * 2e-2);
  EXPECT_NEAR(std::sqrt(walk / count), 1e-3 / 10.0, 0.05 * 1e-4);

  const std::string yaml = read_text(folder.path() / "noisy" / "mav0" / "imu0" / "sensor.yaml");
  EXPECT_THAT(numbers_behind(yaml, "gyroscope_noise_density"), ::testing::Contains(2e-3));
  EXPECT_THAT(numbers_behind(yaml, "rate_hz"), ElementsAre(100.0));
  // PyYAML reads 2e-04, without a point, as text.
  EXPECT_THAT(yaml, HasSubstr("accelerometer_random_walk: 2.0e-04 "));
}

TEST(Euroc, StatesAndExtrinsicsGiveTheCamerasPoses) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({kTwoCameras});
  exported(source, export_options(folder.path() / "d", DatasetFormat::kEuroc));
  const fs::path mav0 = folder.path() / "d" / "mav0";
  const auto truth = read_trajectory(mav0 / "state_groundtruth_estimate0" / "data.csv");
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  EXPECT_EQ(truth->format, TrajectoryFormat::kEuroc);
  std::map<std::int64_t, Pose> T_world_body;
  for (const StampedPose& state : truth->trajectory.poses()) T_world_body[state.t_ns] = state.pose;

  const auto frames = testing::frames_of(source.scenario);
  for (std::size_t camera = 0; camera < 2; ++camera) {
    const fs::path cam = mav0 / ("cam" + std::to_string(camera));
    const std::string yaml = read_text(cam / "sensor.yaml");
    const auto T = numbers_behind(yaml, "data");
    ASSERT_EQ(T.size(), 16U);
    const Eigen::Matrix4d T_body_camera =
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(T.data());
    const auto rows = rows_of(cam / "data.csv", ',');
    ASSERT_EQ(rows.size(), frames.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const CameraShot& shot = frames[i].shots[camera];
      const std::int64_t stamp_ns = std::stoll(rows[i].at(0));
      EXPECT_EQ(stamp_ns, source.epoch_utc_ns + shot.stamp_ns);
      EXPECT_EQ(rows[i].at(1), rows[i].at(0) + ".png");
      ASSERT_TRUE(T_world_body.contains(stamp_ns)) << "100 ms lie on the IMU's raster of 5 ms";
      const Eigen::Matrix4d T_world_camera = T_world_body[stamp_ns].matrix() * T_body_camera;
      EXPECT_LT((T_world_camera - shot.drawn.T_world_camera.matrix()).norm(), 1e-9);
      EXPECT_EQ(different_samples(read_picture(cam / "data" / rows[i].at(1)), shot.image), 0);
    }
  }
  const std::string tilted = read_text(mav0 / "cam1" / "sensor.yaml");
  const PinholeCamera& pinhole = source.scenario.cameras[1].model.pinhole();
  EXPECT_THAT(numbers_behind(tilted, "\nintrinsics"),
              ElementsAre(pinhole.fx_px, pinhole.fy_px, pinhole.cx_px, pinhole.cy_px));
  EXPECT_THAT(numbers_behind(tilted, "distortion_coefficients"),
              ElementsAre(-0.1, 0.01, 0.002, 0.001));
  EXPECT_THAT(numbers_behind(tilted, "resolution"), ElementsAre(96, 64));
  EXPECT_THAT(tilted, HasSubstr("distortion_model: radial-tangential\n"));
}

}  // namespace
}  // namespace overfly::server
