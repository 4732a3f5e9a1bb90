// Whole runs over a small world: folders, determinism, scores, how runs end.
#include "server/run/run.hpp"
#include "server/record/run_info_file.hpp"
#include "server/timeline/run_timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/motion/trajectory_io.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/scoring/run_metrics_json.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using testing::contents_without_timings;
using ::testing::HasSubstr;
using testing::noop_factory;
using testing::options_for;
using testing::small_scenario;

constexpr const char* kThreeTypes =
    R"(estimators=[{"name":"p","type":"perfect"},
                   {"name":"d","type":"drifting","parameters":{"drift":0.01}},
                   {"name":"f","type":"feature","parameters":{"features":300}}])";

void expect_equal_folders(const fs::path& a, const fs::path& b) {
  const auto first = contents_without_timings(a);
  const auto second = contents_without_timings(b);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].first, second[i].first);
    EXPECT_EQ(first[i].second, second[i].second) << first[i].first << " differs";
  }
}

TEST(Run, EqualLockstepRunsAreEqualByteByByteButForTimings) {
  const TemporaryFolder folder;
  const Scenario scenario = small_scenario({kThreeTypes, "recording.frames=true"});
  for (const char* name : {"a", "b"}) {
    const auto run = run_scenario(scenario, options_for(folder.path() / name));
    ASSERT_TRUE(run.ok()) << run.error().message;
    EXPECT_EQ(run->info.frames, 21);
  }
  expect_equal_folders(folder.path() / "a", folder.path() / "b");
  EXPECT_TRUE(fs::exists(folder.path() / "a" / "frames" / "000020.jpg"));
}

TEST(Run, EqualLockstepRunsDrawnWithOpenGlAreEqualByteByByteButForTimings) {
  if (const auto egl = renderer::probe_egl(); !egl) GTEST_SKIP() << egl.error().message;
  const TemporaryFolder folder;
  const Scenario scenario = small_scenario({kThreeTypes, "recording.frames=true"});
  for (const char* name : {"a", "b"}) {
    RunOptions options;
    options.folder = folder.path() / name;
    const auto run = run_scenario(scenario, options);
    ASSERT_TRUE(run.ok()) << run.error().message;
  }
  expect_equal_folders(folder.path() / "a", folder.path() / "b");
}

TEST(Run, PerfectEstimatorHasNoErrorAndDriftingOneTheClosedForm) {
  const TemporaryFolder folder;
  const auto run = run_scenario(small_scenario({kThreeTypes, "duration_s=20"}),
                                options_for(folder.path() / "r"));
  ASSERT_TRUE(run.ok()) << run.error().message;
  const auto& estimators = run->metrics.estimators;
  EXPECT_EQ(estimators.at("p").score.outcome, evaluation::Outcome::kCompleted);
  EXPECT_EQ(estimators.at("p").score.coverage, 1.0);
  EXPECT_TRUE(estimators.at("p").test_estimator);
  EXPECT_FALSE(estimators.at("f").test_estimator);
  const auto& perfect =
      estimators.at("p").score.alignments.at(evaluation::AlignmentMode::kInitScale);
  EXPECT_LT(perfect.position_m.rmse, 1e-6);
  EXPECT_LT(perfect.rotation_deg->rmse, 1e-6);

  // Each step is 1 % too long, so the error at a pose is 1 % of its displacement from the start.
  const auto truth = read_trajectory(CameraFiles::of_main_camera(folder.path() / "r").truth());
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const auto& poses = truth->trajectory.poses();
  ASSERT_EQ(poses.size(), 201U);
  double sum = 0.0;
  for (const StampedPose& stamped : poses) {
    sum += (stamped.pose.translation - poses.front().pose.translation).squaredNorm();
  }
  const double expected = 0.01 * std::sqrt(sum / static_cast<double>(poses.size()));
  const auto& drifting =
      estimators.at("d").score.alignments.at(evaluation::AlignmentMode::kInitScale);
  EXPECT_NEAR(drifting.position_m.rmse, expected, 1e-6);
  EXPECT_LT(drifting.rotation_deg->rmse, 1e-6);
}

TEST(Run, FolderHasEveryFileAndReadsBackAsTheLiveRunWas) {
  const TemporaryFolder folder;
  RunOptions options = options_for(folder.path() / "r");
  const Scenario scenario = small_scenario({kThreeTypes});
  RunInfo info;
  info.id = "r";
  options.timeline = std::make_shared<RunTimeline>(info, std::vector<std::string>{"p", "d", "f"});
  ASSERT_TRUE(run_scenario(scenario, options).ok());
  const auto opened = RunTimeline::open(options.folder);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  EXPECT_EQ((*opened)->info().status, RunStatus::kCompleted);
  EXPECT_EQ(json_from(*(*opened)->metrics()), json_from(*options.timeline->metrics()));
  EXPECT_EQ((*opened)->frame_count(), 21U);
  const auto live = options.timeline->frames(0, 100);
  const auto read = (*opened)->frames(0, 100);
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].t_ns, live[i].t_ns);
    EXPECT_EQ(read[i].T_world_body.matrix(), live[i].T_world_body.matrix());
  }
  for (std::size_t e = 0; e < 3; ++e) {
    const auto live_rows = options.timeline->estimates(e, 0, 100);
    const auto read_rows = (*opened)->estimates(e, 0, 100);
    ASSERT_EQ(read_rows.size(), live_rows.size());
    for (std::size_t i = 0; i < read_rows.size(); ++i) {
      EXPECT_EQ(read_rows[i].sample.state, live_rows[i].sample.state);
      EXPECT_EQ(read_rows[i].latency_ms, live_rows[i].latency_ms);
      ASSERT_EQ(read_rows[i].T_world_body.has_value(), live_rows[i].T_world_body.has_value());
      if (!read_rows[i].T_world_body) continue;
      EXPECT_EQ(read_rows[i].T_world_body->matrix(), live_rows[i].T_world_body->matrix());
    }
  }
  EXPECT_EQ((*opened)->logs(0, 100).size(), options.timeline->logs(0, 100).size());
  for (const char* file : {"scenario.json",
                           "manifest.json",
                           "metrics.json",
                           "timings.json",
                           "created.json",
                           "truth.tum",
                           "estimates/p.tum",
                           "log.jsonl"}) {
    EXPECT_TRUE(fs::exists(options.folder / file)) << file;
  }
  const auto tum = read_trajectory(estimate_tum_file(options.folder, "p"));
  ASSERT_TRUE(tum.ok());
  EXPECT_TRUE(tum->comments.count("init_scene_depth") == 1);
  EXPECT_TRUE(tum->comments.count("init_true_depth") == 1);
}

TEST(Run, ManifestSaysWhatMadeIt) {
  const TemporaryFolder folder;
  ASSERT_TRUE(
      run_scenario(small_scenario({kThreeTypes, "seed=9"}), options_for(folder.path() / "r")).ok());
  const auto manifest = read_json(manifest_file(folder.path() / "r"));
  ASSERT_TRUE(manifest.ok());
  EXPECT_EQ(manifest->at("status"), "completed");
  EXPECT_EQ(manifest->at("seed"), 9);
  EXPECT_EQ(manifest->at("renderer").at("backend"), "noop");
  EXPECT_EQ(manifest->at("estimators").at(2).at("parameters").at("seed"), "9");
  EXPECT_FALSE(manifest->at("world").at("data_hashes").empty());
  EXPECT_FALSE(manifest->at("commit").get<std::string>().empty());
  EXPECT_TRUE(manifest->at("epoch_utc_ns").is_number_integer());
}

TEST(Run, CancelLeavesACompleteFolderUpToTheLastFrame) {
  const TemporaryFolder folder;
  std::atomic<bool> cancel{false};
  RunOptions options = options_for(folder.path() / "r");
  options.cancel = &cancel;
  options.progress = [&](const RunInfo& info) { cancel = info.frames >= 5; };
  const auto run = run_scenario(small_scenario({kThreeTypes}), options);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->info.status, RunStatus::kCancelled);
  EXPECT_EQ(run->metrics.cameras.at(kMainCamera).frames, 5);
  const auto opened = RunTimeline::open(options.folder);
  ASSERT_TRUE(opened.ok());
  EXPECT_EQ((*opened)->info().status, RunStatus::kCancelled);
  EXPECT_EQ((*opened)->estimate_count(0), 5U);
}

TEST(Run, FailureIsToldByResultManifestAndLog) {
  const TemporaryFolder folder;
  RunOptions options = options_for(folder.path() / "r");
  options.renderer_factory = [](auto) -> Result<std::unique_ptr<renderer::Renderer>> {
    return Error{ErrorCode::kUnsupported, "no EGL here"};
  };
  const auto run = run_scenario(small_scenario(), options);
  ASSERT_FALSE(run.ok());
  EXPECT_EQ(run.error().code, ErrorCode::kUnsupported);
  const auto info = read_run_info(options.folder);
  ASSERT_TRUE(info.ok()) << info.error().message;
  EXPECT_EQ(info->status, RunStatus::kFailed);
  EXPECT_THAT(info->error, HasSubstr("no EGL here"));
  const auto opened = RunTimeline::open(options.folder);
  ASSERT_TRUE(opened.ok());
  EXPECT_EQ((*opened)->logs(0, 10).back().level, "error");
}

TEST(Run, RefusesAFolderThatHoldsSomething) {
  const TemporaryFolder folder;
  overfly::testing::write_text(folder.path() / "notes.txt", "mine");
  const auto run = run_scenario(small_scenario(), options_for(folder.path()));
  ASSERT_FALSE(run.ok());
  EXPECT_EQ(run.error().code, ErrorCode::kConflict);
  EXPECT_THAT(run.error().message, HasSubstr("not empty"));
}

TEST(Run, BadEstimatorParameterIsNamed) {
  const TemporaryFolder folder;
  const auto run = run_scenario(
      small_scenario({R"(estimators=[{"name":"p","type":"perfect","parameters":{"scal":1}}])"}),
      options_for(folder.path() / "r"));
  ASSERT_FALSE(run.ok());
  EXPECT_THAT(run.error().message,
              HasSubstr("estimator \"p\": parameters.scal: must be drift, scale or scene_depth_m"));
}

/// Answers twice, then ends.
class Mortal final : public VoPort {
 public:
  std::string type() const override { return "mortal"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Result<VoEstimate> track(const VoFrame& frame) override {
    if (frame.index >= 2) return Error{ErrorCode::kInternal, "out of memory"};
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    estimate.sample.state = TrackingState::kTracking;
    estimate.sample.T_vo_camera.translation.x() = static_cast<double>(frame.index);
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}
};

TEST(Run, CrashedEstimatorIsAnOutcomeNotAFailure) {
  const TemporaryFolder folder;
  RunOptions options = options_for(folder.path() / "r");
  options.estimator_factory = [](const EstimatorSpec&) {
    return Result<std::unique_ptr<VoPort>>(std::make_unique<Mortal>());
  };
  const auto run =
      run_scenario(small_scenario({R"(estimators=[{"name":"m","type":"feature"}])"}), options);
  ASSERT_TRUE(run.ok()) << run.error().message;
  const auto& score = run->metrics.estimators.at("m");
  EXPECT_EQ(score.score.outcome, evaluation::Outcome::kCrashed);
  EXPECT_NEAR(score.score.outcome_time_s.value_or(0.0), 0.2, 1e-9);
  EXPECT_NEAR(score.score.coverage, 2.0 / 21.0, 1e-12);
}

}  // namespace
}  // namespace overfly::server
