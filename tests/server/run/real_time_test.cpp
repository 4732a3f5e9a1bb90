// Real-time pacing under a simulated clock: what is dropped, what is late.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <map>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info.hpp"
#include "server/record/run_records.hpp"
#include "server/run/run_options.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/timing/picture_rate.hpp"
#include "server/timing/run_clock.hpp"
#include "tests/server/support/server_fixture.hpp"
#include "tests/server/support/simulated_clock.hpp"
#include "tests/server/support/wrapped_renderer.hpp"

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using ::testing::ElementsAre;
using testing::SimulatedClock;
using Json = nlohmann::json;

constexpr std::int64_t kMillisecond = 1'000'000;

/// Answers a fixed time after it became ready, by the run's clock.
class SlowEstimator final : public VoPort {
 public:
  SlowEstimator(RunClock& clock, std::int64_t work_ns, std::int64_t start_ns = 0)
      : clock_(clock), work_ns_(work_ns), start_ns_(start_ns) {}
  std::string type() const override { return "slow"; }
  std::map<std::string, std::string> effective_parameters() const override {
    return {{"vocabulary", ready_ ? "loaded" : "absent"}};
  }
  Status prepare(const VoFrame& first) override {
    EXPECT_EQ(first.image, nullptr);
    EXPECT_TRUE(first.intrinsics.validate());
    if (start_ns_ > 0) clock_.sleep_until_ns(clock_.now_ns() + start_ns_);
    ready_ = true;
    return {};
  }
  Result<VoEstimate> track(const VoFrame& frame) override {
    clock_.sleep_until_ns(clock_.now_ns() + work_ns_);
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    estimate.sample.state = TrackingState::kTracking;
    estimate.sample.T_vo_camera.translation.x() = static_cast<double>(frame.index);
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}

 private:
  RunClock& clock_;
  std::int64_t work_ns_;
  std::int64_t start_ns_;
  bool ready_ = false;
};

/// A renderer whose images take a fixed time.
class SlowRenderer final : public testing::WrappedRenderer {
 public:
  SlowRenderer(std::unique_ptr<renderer::Renderer> inner, RunClock& clock, std::int64_t work_ns)
      : WrappedRenderer(std::move(inner)), clock_(clock), work_ns_(work_ns) {}
  using Renderer::render_camera;
  Result<renderer::CameraFrame> render_camera(const renderer::CameraRequest& request) override {
    clock_.sleep_until_ns(clock_.now_ns() + work_ns_);
    return inner().render_camera(request);
  }

 private:
  RunClock& clock_;
  std::int64_t work_ns_;
};

std::vector<std::int64_t> frames_where(const EstimatorRecords& estimator, bool dropped) {
  std::vector<std::int64_t> frames;
  for (const EstimateRecord& record : estimator.records) {
    if (record.dropped == dropped) frames.push_back(record.sample.frame);
  }
  return frames;
}

/// Counts of the first estimator's answers.
std::vector<std::int64_t> counts(const RunTimeline& timeline, std::int64_t EstimateRow::*count) {
  std::vector<std::int64_t> values;
  for (const EstimateRow& row : timeline.estimates(0, 0, timeline.estimate_count(0))) {
    values.push_back(row.*count);
  }
  return values;
}

/// A run in its own folder with the empty renderer and a simulated clock.
class RealTime : public ::testing::Test {
 protected:
  RealTime() {
    options_.folder = folder_.path() / "r";
    options_.renderer_factory = testing::noop_factory();
    options_.clock = &clock_;
  }

  SimulatedClock clock_;
  RunOptions options_;

 private:
  TemporaryFolder folder_;
};

TEST_F(RealTime, BusyEstimatorGetsTheLatestFrameAndTheOthersAreListed) {
  options_.estimator_factory = [&](const EstimatorSpec&) {
    return Result<std::unique_ptr<VoPort>>(
        std::make_unique<SlowEstimator>(clock_, 250 * kMillisecond));
  };
  options_.timeline = std::make_shared<RunTimeline>(RunInfo{}, std::vector<std::string>{"slow"});
  // 10 Hz against 250 ms: 0 is done at 250 and takes 2, that is done at 500. Frame 5 comes at
  // that instant: either of 4 and 5 may be taken, so the flight ends with frame 4, at 400 ms.
  const auto run =
      run_scenario(testing::small_scenario({"pacing=real_time",
                                            "duration_s=0.4",
                                            R"(estimators=[{"name":"slow","type":"feature"}])"}),
                   options_);
  ASSERT_TRUE(run.ok()) << run.error().message;
  const auto records = read_run_records(options_.folder);
  ASSERT_TRUE(records.ok()) << records.error().message;
  EXPECT_THAT(frames_where(records->estimators[0], false), ElementsAre(0, 2, 4));
  EXPECT_THAT(frames_where(records->estimators[0], true), ElementsAre(1, 3));
  const EstimatorMetrics& score = run->metrics.estimators.at("slow");
  EXPECT_EQ(score.dropped_frames, 2);
  EXPECT_EQ(score.score.frames, 5);
  EXPECT_EQ(score.score.coverage, 0.6);
  EXPECT_EQ(score.score.outcome, evaluation::Outcome::kCompleted) << "busy, not lost";
  EXPECT_THAT(score.dropped_frame_ranges, ElementsAre(FrameRange{1, 1}, FrameRange{3, 3}));
  EXPECT_EQ(run->metrics.late_frames, 0);
  EXPECT_EQ(run->info.frames, 5);
  const auto recorded = RunTimeline::open(options_.folder);
  ASSERT_TRUE(recorded.ok()) << recorded.error().message;
  EXPECT_THAT(counts(**recorded, &EstimateRow::dropped_frames), ElementsAre(0, 1, 2));
  EXPECT_THAT(counts(*options_.timeline, &EstimateRow::dropped_frames), ElementsAre(0, 1, 2));
  EXPECT_THAT(counts(**recorded, &EstimateRow::unanswered_frames), ElementsAre(0, 0, 0));
}

/// Time passes only in waits, the third of which is cancelled.
class CancellingClock final : public RunClock {
 public:
  explicit CancellingClock(std::atomic<bool>& cancel) : cancel_(cancel) {}
  std::int64_t now_ns() override { return now_ns_; }
  void sleep_until_ns(std::int64_t t_ns) override { now_ns_ = t_ns; }
  bool wait_until_ns(std::int64_t t_ns, const std::function<bool()>& cancelled) override {
    if (++waits_ == 3) cancel_ = true;
    if (cancelled()) return false;
    now_ns_ = t_ns;
    return true;
  }

 private:
  std::atomic<bool>& cancel_;
  std::atomic<std::int64_t> now_ns_ = 0;
  int waits_ = 0;
};

TEST_F(RealTime, ACancelledFlightDoesNotWaitForItsNextFrame) {
  std::atomic<bool> cancel = false;
  CancellingClock clock(cancel);
  options_.clock = &clock;
  options_.cancel = &cancel;
  const auto run = run_scenario(testing::small_scenario({"pacing=real_time"}), options_);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->info.status, RunStatus::kCancelled);
  EXPECT_EQ(run->info.frames, 3);
}

TEST_F(RealTime, QuickEstimatorDropsNothing) {
  options_.estimator_factory = [&](const EstimatorSpec&) {
    return Result<std::unique_ptr<VoPort>>(
        std::make_unique<SlowEstimator>(clock_, 99 * kMillisecond));
  };
  const auto run =
      run_scenario(testing::small_scenario(
                       {"pacing=real_time", R"(estimators=[{"name":"slow","type":"feature"}])"}),
                   options_);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->metrics.estimators.at("slow").dropped_frames, 0);
  EXPECT_EQ(run->metrics.estimators.at("slow").score.frames, 21);
}

TEST_F(RealTime, TheFlightBeginsWhenItsEstimatorsAreReady) {
  std::int64_t start_ns = 0;
  options_.estimator_factory = [&](const EstimatorSpec&) {
    start_ns += 3000 * kMillisecond;
    return Result<std::unique_ptr<VoPort>>(
        std::make_unique<SlowEstimator>(clock_, 10 * kMillisecond, start_ns));
  };
  const std::int64_t begin_ns = clock_.now_ns();
  const auto run = run_scenario(
      testing::small_scenario(
          {"pacing=real_time",
           R"(estimators=[{"name":"a","type":"feature"},{"name":"b","type":"feature"}])"}),
      options_);
  ASSERT_TRUE(run.ok()) << run.error().message;
  for (const char* name : {"a", "b"}) {
    EXPECT_EQ(run->metrics.estimators.at(name).dropped_frames, 0) << name;
  }
  const Json manifest = read_json(manifest_file(options_.folder)).value();
  EXPECT_EQ(manifest.at("estimators").at(1).at("parameters").at("vocabulary"), "loaded");
  // Both at a time: 6 s, and the flight of 2 s.
  EXPECT_NEAR(static_cast<double>(clock_.now_ns() - begin_ns) * 1e-9, 8.0, 0.2);
}

TEST_F(RealTime, RendererThatFallsBehindSkipsFramesWhoseTimeHasPassed) {
  options_.renderer_factory = [&](std::shared_ptr<const terrain::TileSource> tiles) {
    return Result<std::unique_ptr<renderer::Renderer>>(std::make_unique<SlowRenderer>(
        renderer::create_noop_renderer(std::move(tiles)), clock_, 250 * kMillisecond));
  };
  options_.timeline = std::make_shared<RunTimeline>(RunInfo{}, std::vector<std::string>{"p"});
  // 10 Hz against 250 ms a frame: 0 until 250, so 1 (due by 200) is late; 2 until 500, so 3 and 4
  // (due by 400 and 500) are; 5 until 750, so 6 is; 7 until 1000, so 8 and 9 are; 10.
  const auto run = run_scenario(
      testing::small_scenario(
          {"pacing=real_time", "duration_s=1", R"(estimators=[{"name":"p","type":"perfect"}])"}),
      options_);
  ASSERT_TRUE(run.ok()) << run.error().message;
  const auto records = read_run_records(options_.folder);
  ASSERT_TRUE(records.ok());
  std::vector<std::int64_t> drawn;
  for (const FrameRow& frame : records->main_camera().frames) drawn.push_back(frame.frame);
  EXPECT_THAT(drawn, ElementsAre(0, 2, 5, 7, 10));
  std::vector<std::int64_t> late;
  for (const evaluation::FlightFrame& frame : records->late_frames) late.push_back(frame.frame);
  EXPECT_THAT(late, ElementsAre(1, 3, 4, 6, 8, 9));
  const EstimatorMetrics& score = run->metrics.estimators.at("p");
  EXPECT_EQ(score.score.frames, 11);
  EXPECT_DOUBLE_EQ(score.score.coverage, 5.0 / 11.0);
  EXPECT_THAT(run->metrics.late_frame_ranges,
              ElementsAre(FrameRange{1, 1}, FrameRange{3, 4}, FrameRange{6, 6}, FrameRange{8, 9}));
  const auto recorded = RunTimeline::open(options_.folder);
  ASSERT_TRUE(recorded.ok()) << recorded.error().message;
  for (const RunTimeline* timeline : {options_.timeline.get(), recorded->get()}) {
    std::vector<std::int64_t> late_so_far;
    for (const FrameRow& row : timeline->frames(0, 5)) late_so_far.push_back(row.late_frames);
    EXPECT_THAT(late_so_far, ElementsAre(0, 1, 3, 4, 6));
  }
}

TEST_F(RealTime, PicturesForViewersGiveWayToFramesThatComeLate) {
  options_.renderer_factory = [&](std::shared_ptr<const terrain::TileSource> tiles) {
    return Result<std::unique_ptr<renderer::Renderer>>(std::make_unique<SlowRenderer>(
        renderer::create_noop_renderer(std::move(tiles)), clock_, 250 * kMillisecond));
  };
  PictureRate rate;
  options_.picture_rate = &rate;
  std::vector<double> limits_hz;
  options_.progress = [&](const RunInfo&) { limits_hz.push_back(rate.limit_hz().value_or(0.0)); };
  const auto run =
      run_scenario(testing::small_scenario({"pacing=real_time", "duration_s=1"}), options_);
  ASSERT_TRUE(run.ok()) << run.error().message;
  // One missed between frames 0 and 2, two between 2 and 5: as in the test above.
  EXPECT_THAT(limits_hz, ElementsAre(5.0, 2.0, 1.0, 1.0, 1.0));
  EXPECT_FALSE(rate.flying());
}

}  // namespace
}  // namespace overfly::server
