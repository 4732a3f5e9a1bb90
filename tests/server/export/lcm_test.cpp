// LCM event logs, read back by LCM's own reader. Skipped where LCM is not built in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/measure/crc32.hpp"
#include "middleware/lcm/findings.hpp"
#include "tests/server/export/export_fixture.hpp"
#include "vo_bridges/vo_port.hpp"

#ifdef OVERFLY_TESTS_LCM
#include <lcm/lcm-cpp.hpp>
#include <overfly_lcm/calibration_t.hpp>
#include <overfly_lcm/gps_t.hpp>
#include <overfly_lcm/image_t.hpp>
#include <overfly_lcm/imu_t.hpp>
#include <overfly_lcm/pose_t.hpp>
#include <overfly_lcm/sim_time_t.hpp>
#include <overfly_lcm/truth_t.hpp>
#include <overfly_lcm/world_pose_t.hpp>
#endif

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using testing::export_options;
using testing::exported;
using ::testing::HasSubstr;
using testing::small_source;

TEST(LcmExport, IsRefusedWhereLcmIsNotBuiltIn) {
  if (lcm::is_built_in()) GTEST_SKIP() << "LCM is built in";
  const TemporaryFolder folder;
  const auto summary =
      export_dataset(small_source(), export_options(folder.path() / "d", DatasetFormat::kLcm));
  ASSERT_FALSE(summary.ok());
  EXPECT_EQ(summary.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(summary.error().message, HasSubstr("liblcm-dev"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "d"));
}

#ifdef OVERFLY_TESTS_LCM

/// The events of a log by channel, each with its time.
struct Log {
  template <typename Message>
  std::vector<Message> decoded(const std::string& channel) const {
    std::vector<Message> messages;
    for (const auto& event : events) {
      if (event.channel != channel) continue;
      messages.emplace_back();
      EXPECT_GT(messages.back().decode(event.bytes.data(), 0, static_cast<int>(event.bytes.size())),
                0)
          << channel;
    }
    return messages;
  }

  struct Event {
    std::int64_t utc_us = 0;
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Event> events;
};

Log read_log(const std::filesystem::path& file) {
  Log log;
  ::lcm::LogFile source(file.string(), "r");
  EXPECT_TRUE(source.good());
  while (const ::lcm::LogEvent* event = source.readNextEvent()) {
    const auto* bytes = static_cast<const std::uint8_t*>(event->data);
    log.events.push_back({event->timestamp, event->channel, {bytes, bytes + event->datalen}});
  }
  return log;
}

constexpr const char* kTwoLost =
    R"(faults=[{"kind":"dropped_frames","at_s":0.35,"duration_s":0.2}])";

TEST(LcmExport, HoldsTheImagesThatEstimatorsAreGivenAndTheTruePoses) {
  const TemporaryFolder folder;
  const ExportSource source =
      small_source({kTwoLost, R"(camera.sensor={"exposure_ms":3,"shot_noise":true})"});
  const ExportSummary summary =
      exported(source, export_options(folder.path() / "d", DatasetFormat::kLcm));
  const Log log = read_log(folder.path() / "d" / "flight.lcm");
  const auto images = log.decoded<overfly_lcm::image_t>("OVERFLY_IMAGE");
  const auto times = log.decoded<overfly_lcm::sim_time_t>("OVERFLY_TIME");
  const auto truths = log.decoded<overfly_lcm::truth_t>("OVERFLY_TRUTH");
  ASSERT_EQ(images.size(), static_cast<std::size_t>(summary.images));
  ASSERT_LT(summary.images, summary.frames);
  ASSERT_EQ(times.size(), images.size());
  ASSERT_EQ(truths.size(), images.size());
  std::size_t i = 0;
  for (const MadeFrame& frame : testing::frames_of(source.scenario)) {
    const CameraShot& shot = frame.shots.front();
    if (!shot.delivered) continue;
    EXPECT_EQ(images[i].data, shot.image.data);
    EXPECT_EQ(images[i].crc32, crc32_of(shot.image));
    EXPECT_EQ(images[i].frame, frame.frame);
    EXPECT_EQ(images[i].t_ns, shot.stamp_ns);
    EXPECT_EQ(images[i].exposure_ns, 3'000'000);
    EXPECT_EQ(images[i].sequence, static_cast<std::int64_t>(i) + 1);
    EXPECT_EQ(times[i].t_ns, shot.stamp_ns);
    EXPECT_EQ(times[i].sequence, images[i].sequence);
    const Pose& T = shot.drawn.T_world_camera;
    EXPECT_EQ(truths[i].t_ns, frame.t_ns);
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(truths[i].position[axis], T.translation[axis]);
    EXPECT_EQ(truths[i].orientation[0], T.rotation.x());
    EXPECT_EQ(truths[i].orientation[3], T.rotation.w());
    ++i;
  }
  EXPECT_EQ(i, images.size());
}

TEST(LcmExport, TellsTheCalibrationOncePerSecondInOneSession) {
  const TemporaryFolder folder;
  const ExportSource source = small_source();
  exported(source, export_options(folder.path() / "d", DatasetFormat::kLcm));
  const Log log = read_log(folder.path() / "d" / "flight.lcm");
  ASSERT_FALSE(log.events.empty());
  EXPECT_EQ(log.events.front().channel, "OVERFLY_CALIBRATION");
  const auto calibrations = log.decoded<overfly_lcm::calibration_t>("OVERFLY_CALIBRATION");
  const auto images = log.decoded<overfly_lcm::image_t>("OVERFLY_IMAGE");
  const double duration_s = s_from_ns(images.back().t_ns - images.front().t_ns);
  EXPECT_NEAR(static_cast<double>(calibrations.size()), duration_s + 1.0, 1.0);
  const PinholeCamera& c = source.scenario.cameras.front().model.pinhole();
  for (const auto& calibration : calibrations) {
    EXPECT_EQ(calibration.session, images.front().session);
    EXPECT_EQ(calibration.camera, "camera0");
    EXPECT_EQ(calibration.fx, c.fx_px);
    EXPECT_EQ(calibration.cy, c.cy_px);
    EXPECT_EQ(calibration.distortion_model, "none");
  }
}

TEST(LcmExport, OfARunHoldsTheAnswersOfItsEstimators) {
  const TemporaryFolder folder;
  RunOptions run = testing::options_for(folder.path() / "run");
  run.renderer_factory = testing::raycast_factory();
  // An estimator that initialises late, and one whose scale is known.
  const Scenario scenario = testing::small_scenario(
      {R"(estimators=[{"name":"d-1","type":"drifting","parameters":{"scale":0.5}},)"
       R"({"name":"f","type":"feature"}])"});
  ASSERT_TRUE(run_scenario(scenario, run).ok());
  const auto source = open_export_source(folder.path() / "run");
  ASSERT_TRUE(source.ok()) << source.error().message;
  const auto options = export_options(folder.path() / "d", DatasetFormat::kLcm);
  const ExportSummary summary = exported(*source, options);
  const Log log = read_log(options.folder / "flight.lcm");
  const auto images = log.decoded<overfly_lcm::image_t>("OVERFLY_IMAGE");
  const auto truth = log.decoded<overfly_lcm::truth_t>("OVERFLY_TRUTH");
  ASSERT_EQ(source->run->estimates.size(), 2U);
  for (const PlannedEstimate& estimate : source->run->estimates) {
    const auto poses =
        log.decoded<overfly_lcm::pose_t>("ESTIMATE_" + estimate.track.name + "_POSE");
    ASSERT_EQ(poses.size(), static_cast<std::size_t>(summary.frames));
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const EstimateSample& sample = estimate.track.samples[i];
      EXPECT_EQ(poses[i].t_ns, images[i].t_ns);
      EXPECT_EQ(poses[i].session, images[i].session);
      EXPECT_EQ(poses[i].frame, sample.frame);
      EXPECT_EQ(poses[i].sequence, static_cast<std::int64_t>(i) + 1);
      EXPECT_EQ(poses[i].map_id, sample.map_id);
      const bool tracking = sample.state == TrackingState::kTracking;
      EXPECT_EQ(poses[i].state == overfly_lcm::pose_t::TRACKING, tracking);
      if (!tracking) continue;
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(poses[i].position[axis], sample.T_vo_camera.translation[axis]);
      }
      EXPECT_EQ(poses[i].orientation[3], sample.T_vo_camera.rotation.w());
      EXPECT_EQ(poses[i].scene_depth, sample.scene_depth.value_or(0.0));
    }
  }
  const auto in_world = log.decoded<overfly_lcm::world_pose_t>("ESTIMATE_d-1_POSE_WORLD");
  ASSERT_EQ(in_world.size(), truth.size());
  for (std::size_t i = 0; i < in_world.size(); ++i) {
    const Eigen::Vector3d estimated(in_world[i].position);
    EXPECT_LT((estimated - Eigen::Vector3d(truth[i].position)).norm(), 1.0);
  }
}

TEST(LcmExport, StampsEventsInOrderByUtc) {
  const TemporaryFolder folder;
  const ExportSource source = small_source();
  exported(source, export_options(folder.path() / "d", DatasetFormat::kLcm));
  const Log log = read_log(folder.path() / "d" / "flight.lcm");
  std::int64_t before_us = 0;
  for (const auto& event : log.events) {
    EXPECT_GE(event.utc_us, before_us);
    before_us = event.utc_us;
  }
  const auto images = log.decoded<overfly_lcm::image_t>("OVERFLY_IMAGE");
  EXPECT_EQ(before_us, source.epoch_utc_ns / 1000 + images.back().t_ns / 1000);
}

TEST(LcmExport, GivesEstimatorsTheLumaOfColourImages) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({"duration_s=0.1", "camera.color=rgb"});
  exported(source, export_options(folder.path() / "d", DatasetFormat::kLcm));
  const auto images =
      read_log(folder.path() / "d" / "flight.lcm").decoded<overfly_lcm::image_t>("OVERFLY_IMAGE");
  const auto frames = testing::frames_of(source.scenario);
  ASSERT_FALSE(images.empty());
  ASSERT_EQ(frames.front().shots.front().image.channels, 3);
  EXPECT_EQ(images.front().data, grey_of(frames.front().shots.front().image).data);
  EXPECT_EQ(images.front().pixelformat, overfly_lcm::image_t::PIXEL_FORMAT_GREY);
}

TEST(LcmExport, HasTheSamplesOfSensorsOfTheExportedSpan) {
  const TemporaryFolder folder;
  const ExportSource source = small_source({R"(sensors={"imu":{},"gps":{"delay_s":0.2}})"});
  ExportOptions options = export_options(folder.path() / "d", DatasetFormat::kLcm);
  options.from_s = 0.95;
  exported(source, options);
  const Log log = read_log(options.folder / "flight.lcm");
  const auto imu = log.decoded<overfly_lcm::imu_t>("OVERFLY_IMU");
  // A sample is available half a period after its time: those since the frame at 0.9 s, to the last
  // frame at 2.0 s.
  ASSERT_EQ(imu.size(), 220U);
  EXPECT_EQ(imu.front().t_ns, 900'000'000);
  EXPECT_EQ(imu.back().t_ns, 1'995'000'000);
  const auto gps = log.decoded<overfly_lcm::gps_t>("OVERFLY_GPS");
  ASSERT_FALSE(gps.empty());
  EXPECT_EQ(gps.front().t_ns, 800'000'000) << "delivered with the first frame";
  for (const overfly_lcm::gps_t& fix : gps) EXPECT_EQ(fix.delivered_ns, fix.t_ns + 200'000'000);
  std::int64_t before_us = 0;
  for (const auto& event : log.events) {
    EXPECT_GE(event.utc_us, before_us) << event.channel;
    before_us = event.utc_us;
  }
}

#else

TEST(LcmExport, IsReadBackByLcm) { GTEST_SKIP() << "LCM is not built in"; }

#endif

}  // namespace
}  // namespace overfly::server
