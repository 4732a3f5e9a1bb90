// Whole runs with several cameras, sensors and faults: what is recorded, and what estimators get.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "core/motion/trajectory_io.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/rows/rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/run/run_options.hpp"
#include "server/timeline/estimate_errors.hpp"
#include "server/timeline/run_timeline.hpp"
#include "tests/server/support/server_fixture.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::larger_error;
using overfly::testing::TemporaryFolder;
using ::testing::Contains;
using testing::contents_without_timings;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::noop_factory;
using ::testing::Not;
using testing::options_for;
using testing::small_scenario;

constexpr const char* kTwoCameras =
    R"(cameras=[{"name":"down","width_px":160,"height_px":120,"rate_hz":10},
                {"name":"tilted","width_px":96,"height_px":64,"rate_hz":10,"color":"rgb",
                 "distortion":{"model":"radtan","coefficients":[-0.1,0.01,0,0]},
                 "mount":{"pitch_deg":25,"p_body_m":[0.2,1,0]}}])";
constexpr const char* kTwoEstimators =
    R"(estimators=[{"name":"p","type":"perfect"},
                   {"name":"q","type":"perfect","camera":"tilted"}])";

/// What an estimator received.
struct Given {
  std::int64_t index = 0;
  std::int64_t t_ns = 0;
  std::int64_t exposure_ns = 0;
  std::string camera;
  Image image;
  DistortionModel lens = DistortionModel::kNone;
};

/// Records what it receives and tracks nothing.
class FrameNotes final : public VoPort {
 public:
  explicit FrameNotes(std::vector<Given>& given) : given_(given) {}
  std::string type() const override { return "notes"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Result<VoEstimate> track(const VoFrame& frame) override {
    given_.push_back({frame.index,
                      frame.t_ns,
                      frame.exposure_ns,
                      frame.camera_id,
                      *frame.image,
                      frame.distortion.model});
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}

 private:
  std::vector<Given>& given_;
};

/// Flies with a witness instead of each estimator.
std::map<std::string, std::vector<Given>> witnessed(const Scenario& scenario,
                                                    const fs::path& folder) {
  std::map<std::string, std::vector<Given>> given;
  RunOptions options = options_for(folder);
  options.estimator_factory = [&](const EstimatorSpec& spec) {
    return Result<std::unique_ptr<VoPort>>(std::make_unique<FrameNotes>(given[spec.name]));
  };
  const auto run = run_scenario(scenario, options);
  EXPECT_TRUE(run.ok()) << run.error().message;
  return given;
}

TEST(CameraRun, EachEstimatorGetsItsCamera) {
  const TemporaryFolder folder;
  const Scenario scenario = small_scenario({kTwoCameras, kTwoEstimators});
  const auto given = witnessed(scenario, folder.path() / "r");
  ASSERT_EQ(given.at("p").size(), 21U);
  ASSERT_EQ(given.at("q").size(), 21U);
  for (std::size_t k = 0; k < 21; ++k) {
    const Given& p = given.at("p")[k];
    const Given& q = given.at("q")[k];
    EXPECT_EQ(p.t_ns, q.t_ns);
    EXPECT_EQ(p.camera, "down");
    EXPECT_EQ(q.camera, "tilted");
    EXPECT_EQ(q.image.width_px, 96);
    EXPECT_EQ(q.image.channels, 1) << "colour must have become grey";
    EXPECT_EQ(q.lens, DistortionModel::kRadtan);
  }
}

TEST(CameraRun, RecordsEveryCameraAndScoresEachEstimatorAgainstItsOwn) {
  const TemporaryFolder folder;
  const Scenario scenario = small_scenario({kTwoCameras, kTwoEstimators, "recording.frames=true"});
  const auto run = run_scenario(scenario, options_for(folder.path() / "r"));
  ASSERT_TRUE(run.ok()) << run.error().message;
  for (const char* name : {"p", "q"}) {
    const EstimatorMetrics& score = run->metrics.estimators.at(name);
    EXPECT_EQ(score.score.outcome, evaluation::Outcome::kCompleted) << name;
    EXPECT_LT(score.score.alignments.at(evaluation::AlignmentMode::kInitScale).position_m.rmse,
              1e-6);
    EXPECT_LT(score.score.alignments.at(evaluation::AlignmentMode::kInitScale).rotation_deg->rmse,
              1e-6);
  }
  EXPECT_EQ(run->metrics.cameras.at(1).frames, 21);
  EXPECT_TRUE(fs::exists(folder.path() / "r/frames/000020.jpg"));
  EXPECT_TRUE(fs::exists(folder.path() / "r/frames/tilted/000020.jpg"));

  const auto opened = RunTimeline::open(folder.path() / "r");
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  ASSERT_EQ((*opened)->cameras().size(), 2U);
  EXPECT_EQ((*opened)->cameras()[1].name, "tilted");
  EXPECT_EQ((*opened)->cameras()[1].model.distortion().k[0], -0.1);
  EXPECT_THAT((*opened)->info().cameras, ElementsAre("down", "tilted"));
  EXPECT_THAT((*opened)->info().estimator_cameras, ElementsAre("down", "tilted"));
  const auto main = (*opened)->frames(0, 100);
  const auto other = (*opened)->frames(0, 100, 1);
  ASSERT_EQ(other.size(), 21U);
  for (std::size_t k = 0; k < 21; ++k) {
    EXPECT_EQ(other[k].t_ns, main[k].t_ns);
    EXPECT_LT((other[k].T_world_body.matrix() - main[k].T_world_body.matrix()).norm(), 1e-9);
  }
  const auto truth = read_trajectory(folder.path() / "r/cameras/tilted.tum");
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  EXPECT_EQ(truth->trajectory.size(), 21U);
}

TEST(CameraRun, FaultsAreInTheRecordInTheLogAndAtTheEstimator) {
  const TemporaryFolder folder;
  const Scenario scenario =
      small_scenario({R"(estimators=[{"name":"w","type":"feature"}])",
                      "recording.frames=true",
                      R"(faults=[{"kind":"dropped_frames","at_s":0.3,"duration_s":0.2},
                  {"kind":"frozen_frame","at_s":0.7,"duration_s":0.2},
                  {"kind":"blackout","at_s":1.1,"duration_s":0.1},
                  {"kind":"stamp_offset","at_s":1.5,"duration_s":0.1,"offset_ms":20}])"});
  const auto given = witnessed(scenario, folder.path() / "r").at("w");
  std::map<std::int64_t, Given> by_index;
  for (const Given& frame : given) by_index[frame.index] = frame;
  EXPECT_EQ(given.size(), 19U);
  EXPECT_EQ(by_index.count(3) + by_index.count(4), 0U) << "dropped";
  EXPECT_EQ(by_index.at(7).image.data, by_index.at(6).image.data) << "frozen";
  EXPECT_NE(by_index.at(9).image.data, by_index.at(6).image.data);
  EXPECT_EQ(by_index.at(11).image.data, std::vector<std::uint8_t>(160 * 120, 0)) << "black";
  EXPECT_EQ(by_index.at(15).t_ns, 1'520'000'000);
  EXPECT_EQ(by_index.at(16).t_ns, 1'600'000'000);

  const auto opened = RunTimeline::open(folder.path() / "r");
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  const auto rows = (*opened)->frames(0, 100);
  ASSERT_EQ(rows.size(), 21U);
  EXPECT_THAT(rows[2].faults, ElementsAre());
  EXPECT_THAT(rows[3].faults, ElementsAre("dropped_frames"));
  EXPECT_THAT(rows[8].faults, ElementsAre("frozen_frame"));
  EXPECT_THAT(rows[11].faults, ElementsAre("blackout"));
  EXPECT_EQ(rows[15].stamp_offset_ns, 20'000'000);
  EXPECT_EQ(rows[15].t_ns, 1'500'000'000) << "the truth keeps its time";
  std::vector<std::string> told;
  for (const LogRow& line : (*opened)->logs(0, 100)) {
    if (line.kind == "fault") told.push_back(line.text);
  }
  EXPECT_EQ(told.size(), 8U);
  EXPECT_THAT(told, Contains("blackout begins, for 0.1 s"));
  EXPECT_THAT(told, Contains("stamp_offset ends"));
  EXPECT_FALSE(fs::exists(folder.path() / "r/frames/000003.jpg")) << "it got lost";
  EXPECT_TRUE(fs::exists(folder.path() / "r/frames/000005.jpg"));
  EXPECT_EQ((*opened)->metrics()->cameras.at(kMainCamera).faults.at("dropped_frames"), 2);
}

TEST(CameraRun, WrongStampsShowAsErrorAlongTheTrack) {
  const TemporaryFolder folder;
  const Scenario scenario =
      small_scenario({R"(estimators=[{"name":"p","type":"perfect"}])",
                      R"(faults=[{"kind":"stamp_offset","at_s":1,"offset_ms":-40}])"});
  const auto run = run_scenario(scenario, options_for(folder.path() / "r"));
  ASSERT_TRUE(run.ok()) << run.error().message;
  const EstimatorMetrics& score = run->metrics.estimators.at("p");
  // Frames from 1 s on have a stamp 40 ms too early: 1 m at 25 m/s.
  const double scored_m =
      score.score.alignments.at(evaluation::AlignmentMode::kInitScale).position_m.max;
  EXPECT_NEAR(scored_m, 1.0, 0.01);
  const auto opened = RunTimeline::open(folder.path() / "r");
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  double plotted_m = 0.0;
  for (const auto& error :
       errors_of(**opened, 0, (*opened)->estimates(0, 0, 100), RowAlignment())) {
    plotted_m = std::max(plotted_m, error.value().position_m());
  }
  EXPECT_NEAR(plotted_m, scored_m, 1e-6);
}

class CameraRunOn : public ::testing::TestWithParam<const char*> {};

TEST_P(CameraRunOn, WithEverythingOnEqualRunsAreEqualByteByByte) {
  const std::string backend = GetParam();
  const TemporaryFolder folder;
  const Scenario scenario = small_scenario(
      {R"(cameras=[{"name":"a","width_px":160,"height_px":120,"rate_hz":10,"bits":12,
            "distortion":{"model":"equidistant","coefficients":[0.01,0,0,0]},
            "atmosphere":{"visibility_km":8},
            "sensor":{"exposure_ms":4,"readout_ms":15,"motion_blur":true,"shot_noise":true,
                      "read_noise_e":10,"full_well_e":12000,"prnu":0.01,"dsnu_e":5,
                      "defocus_sigma_px":0.6,"vignette":[-0.3,0.02,0],"auto_exposure":{}},
            "vibration":{"engine_rotation_rms_mrad":[1,0.5],"noise_translation_rms_mm":[1,1,1]}},
                   {"name":"b","width_px":80,"height_px":64,"rate_hz":10,"color":"rgb",
            "sensor":{"shot_noise":true},"mount":{"facing":"forward","pitch_deg":-40}}])",
       R"(light={"sun_azimuth_deg":200,"sun_elevation_deg":35,"clouds":{"cover":0.3}})",
       R"(detail={"octaves":1})",
       "recording.frames=true",
       "duration_s=1.2",
       R"(renderer={"threads":2})",
       "renderer.camera=" + backend,
       R"(estimators=[{"name":"f","type":"feature","parameters":{"features":200}},
                      {"name":"d","type":"drifting","camera":"b"}])",
       R"(faults=[{"kind":"dropped_frames","at_s":0.2,"probability":0.2},
                  {"kind":"dirt","at_s":0.3,"duration_s":0.3},
                  {"kind":"water_drop","at_s":0.5,"camera":"b","radius_px":20},
                  {"kind":"stamp_jitter","at_s":0,"sigma_ms":3},
                  {"kind":"saturation_burst","at_s":0.9,"duration_s":0.2,"strength":3}])"});
  for (const char* name : {"one", "two"}) {
    RunOptions options;
    options.folder = folder.path() / name;
    const auto run = run_scenario(scenario, options);
    if (!run && run.error().code == ErrorCode::kUnsupported) GTEST_SKIP() << run.error().message;
    ASSERT_TRUE(run.ok()) << run.error().message;
  }
  const auto one = contents_without_timings(folder.path() / "one");
  const auto two = contents_without_timings(folder.path() / "two");
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].first, two[i].first);
    EXPECT_EQ(one[i].second, two[i].second) << one[i].first << " differs";
  }
  const auto manifest = read_json(folder.path() / "one/manifest.json");
  ASSERT_TRUE(manifest.ok());
  EXPECT_EQ(manifest->at("cameras").at(0).at("distortion").at("model"), "equidistant");
  EXPECT_EQ(manifest->at("cameras").at(0).at("bits"), 12);
  EXPECT_TRUE(manifest->at("world").contains("light"));
  EXPECT_TRUE(manifest->at("world").contains("detail"));
  EXPECT_EQ(manifest->at("renderer").at("backend"), backend);
}

INSTANTIATE_TEST_SUITE_P(Renderers, CameraRunOn, ::testing::Values("raycast", "egl"));

TEST(CameraRun, ShakenCameraRecordsTheBodysOwnPose) {
  const TemporaryFolder folder;
  const Scenario scenario =
      small_scenario({"camera.vibration.noise_rotation_rms_mrad=[2,2,2]", "duration_s=1"});
  ASSERT_TRUE(run_scenario(scenario, options_for(folder.path() / "r")).ok());
  ASSERT_TRUE(
      run_scenario(small_scenario({"duration_s=1"}), options_for(folder.path() / "still")).ok());
  const auto shaken = RunTimeline::open(folder.path() / "r");
  const auto still = RunTimeline::open(folder.path() / "still");
  ASSERT_TRUE(shaken.ok() && still.ok());
  double largest = 0.0;
  for (std::size_t k = 0; k < 11; ++k) {
    const FrameRow a = (*shaken)->frames(k, 1).front();
    const FrameRow b = (*still)->frames(k, 1).front();
    EXPECT_LT((a.T_world_body.matrix() - b.T_world_body.matrix()).norm(), 1e-9);
    largest = larger_error(
        largest, rotation_angle_rad(a.T_world_camera.rotation, b.T_world_camera.rotation));
  }
  EXPECT_GT(largest, 1e-4);
}

TEST(CameraRun, CoarseImageryIsFlagged) {
  const TemporaryFolder folder;
  // 2 m texels from 300 m: 160 px over 84.9 deg see 3.4 m a pixel, 1600 px 0.34 m.
  const auto fine =
      run_scenario(small_scenario({"duration_s=0.2"}), options_for(folder.path() / "a"));
  ASSERT_TRUE(fine.ok()) << fine.error().message;
  EXPECT_FALSE(fine->info.texture_limited);
  EXPECT_FALSE(fine->metrics.cameras.at(kMainCamera).texture.limited);
  const auto coarse = run_scenario(
      small_scenario({"duration_s=0.2", "camera.width_px=1600", "camera.height_px=64"}),
      options_for(folder.path() / "b"));
  ASSERT_TRUE(coarse.ok()) << coarse.error().message;
  EXPECT_TRUE(coarse->info.texture_limited);
  EXPECT_LT(coarse->metrics.cameras.at(kMainCamera).texture.texels_per_pixel_median, 0.5);
  const auto info = read_run_info(folder.path() / "b");
  ASSERT_TRUE(info.ok());
  EXPECT_TRUE(info->texture_limited);
}

TEST(CameraRun, BadSensorIsNamedWithItsCamera) {
  const TemporaryFolder folder;
  const auto run = run_scenario(small_scenario({R"(camera.sensor={"vignette":[-3,0,0]})"}),
                                options_for(folder.path() / "r"));
  ASSERT_FALSE(run.ok());
  EXPECT_THAT(run.error().message, HasSubstr("camera \"camera0\": sensor"));
}

}  // namespace
}  // namespace overfly::server
