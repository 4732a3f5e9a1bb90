// What only one of the upstream systems does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/support.hpp"
#include "tests/vo_bridges/adapters/adapter_run.hpp"

namespace overfly::testing {
namespace {

using ::testing::HasSubstr;

TEST(OrbSlam2Adapter, ClosesNoLoopHoweverManyKeyframesThereAre) {
  AdapterRun run("orbslam2");
  const VoEstimate answer = run.track_plain(40);
  EXPECT_GT(answer.counters.at("keyframes"), 30.0);
  EXPECT_EQ(answer.counters.at("loops_closed"), 0.0);
  EXPECT_EQ(run.port().effective_parameters().at("loop_closing"), "false");
}

TEST(OrbSlam2Adapter, FeedsTheDatabaseThatRelocalisationAsks) {
  AdapterRun run("orbslam2");
  run.track_plain(30);
  EXPECT_EQ(run.track(standins::kDark).sample.state, TrackingState::kLost);
  const EstimateSample found = run.track().sample;
  EXPECT_EQ(found.state, TrackingState::kTracking) << "the stand-in asks its database";
  EXPECT_EQ(found.map_id, 0);
}

TEST(OrbSlam2Adapter, KeepsLoopsOpenAfterItHasStartedOver) {
  AdapterRun run("orbslam2");
  run.track_plain(8);
  run.track(standins::kThrowMapAway);
  const VoEstimate answer = run.track_plain(40);
  EXPECT_EQ(answer.sample.map_id, 1);
  EXPECT_EQ(answer.counters.at("loops_closed"), 0.0);
}

TEST(OrbSlam2Adapter, StartsOverWhenLostWithFewKeyframes) {
  AdapterRun run("orbslam2");
  run.track_plain(5);
  EXPECT_EQ(run.track(standins::kDark).sample.state, TrackingState::kLost);
  EXPECT_EQ(run.track().sample.state, TrackingState::kInitialising);
  EXPECT_EQ(run.track_plain(3).sample.map_id, 1);
}

TEST(OrbSlam2Adapter, WaitsForItsMappingInLockstep) {
  AdapterRun run("orbslam2");
  for (int i = 1; i <= 10; ++i) {
    const VoEstimate answer = run.track();
    if (i < 3) continue;
    EXPECT_EQ(answer.counters.at("keyframes"), i - 2) << "each frame's keyframe is in the map";
  }
}

TEST(OrbSlam2Adapter, TurnsItsImageIntoRgb) {
  AdapterRun run("orbslam2");
  run.port().set_debug(true);
  const VoEstimate answer = run.track();
  ASSERT_TRUE(answer.debug_image.has_value());
  EXPECT_EQ(answer.debug_image->at(5, 5, 0), 50) << "the stand-in draws blue 200, red 50";
  EXPECT_EQ(answer.debug_image->at(5, 5, 2), 200);
}

TEST(OrbSlam2Adapter, NamesAVocabularyThatIsNotThere) {
  EXPECT_THAT(refusal("orbslam2", {{"vocabulary", std::string("/nowhere/ORBvoc.txt")}}),
              HasSubstr("parameter vocabulary = '/nowhere/ORBvoc.txt': no such file"));
}

TEST(DsoAdapter, KeepsTheValueAskedForInModeTwo) {
  AdapterRun run("dso", {{"mode", 2.0}, {"preset", std::string("setting_minGradHistAdd_5")}});
  run.track();
  EXPECT_EQ(run.port().effective_parameters().at("setting_minGradHistAdd"), "5");
  EXPECT_EQ(run.port().effective_parameters().at("setting_affineOptModeA"), "-1");
}

TEST(DsoAdapter, TellsTheValueThatModeTwoBringsAlong) {
  AdapterRun run("dso", {{"mode", 2.0}});
  run.track();
  EXPECT_EQ(run.port().effective_parameters().at("setting_minGradHistAdd"), "3");
}

TEST(DsoAdapter, RefusesPresetsThatResizeTheFrames) {
  EXPECT_THAT(refusal("dso", {{"preset", std::string("2")}}), HasSubstr("424 x 320"));
  EXPECT_THAT(refusal("dso", {{"preset", std::string("3")}}), HasSubstr("424 x 320"));
}

TEST(DsoAdapter, RefusesToRunOnFramesThatWereResizedInSilence) {
  const Environment resizes("STANDIN_RESIZES");
  EXPECT_THAT(refusal("dso", {}),
              HasSubstr("DSO has resized the frames from 320 x 240 to 424 x 320"));
}

TEST(DsoAdapter, TakesTheHalfPixelOffOnce) {
  AdapterRun run("dso");
  run.track();
  const auto parameters = run.port().effective_parameters();
  EXPECT_EQ(parameters.at("cxG"), "159.5") << "the centre of 320 px, pixel centres at integers";
  EXPECT_EQ(parameters.at("cyG"), "119.5");
  EXPECT_EQ(parameters.at("wG"), "320");
}

TEST(DsoAdapter, StartsANewSystemAfterALoss) {
  AdapterRun run("dso");
  run.track_plain(8);
  EXPECT_EQ(run.track(standins::kDark).sample.state, TrackingState::kLost);
  EXPECT_EQ(run.track().sample.state, TrackingState::kInitialising);
  const EstimateSample again = run.track_plain(3).sample;
  EXPECT_EQ(again.state, TrackingState::kTracking);
  EXPECT_EQ(again.map_id, 1);
}

TEST(DsoAdapter, StaysLostWhereToldTo) {
  AdapterRun run("dso", {{"restart_after_loss", false}});
  run.track_plain(8);
  run.track(standins::kDark);
  EXPECT_EQ(run.track_plain(6).sample.state, TrackingState::kLost);
}

TEST(DsoAdapter, RunsOneThreadInLockstepAndItsOwnInRealTime) {
  AdapterRun lockstep("dso");
  lockstep.track();
  EXPECT_EQ(lockstep.port().effective_parameters().at("linearizeOperation"), "true");
  EXPECT_EQ(lockstep.port().effective_parameters().at("multiThreading"), "false");
  AdapterRun live("dso", {}, false);
  live.track();
  EXPECT_EQ(live.port().effective_parameters().at("linearizeOperation"), "false");
  EXPECT_EQ(live.port().effective_parameters().at("multiThreading"), "true");
}

TEST(DsoAdapter, RefusesASizeThatDoesNotHalve) {
  auto started = start_adapter("dso");
  ASSERT_TRUE(started.ok());
  VoFrame frame = ordered_frame(0);
  frame.image = std::make_shared<const Image>(321, 241, 1);
  frame.intrinsics = PinholeCamera::from_fov(321, 241, 1.48, FovAxis::kHorizontal).value();
  const Result<VoEstimate> answer = started.value()->track(frame);
  ASSERT_FALSE(answer.ok());
  EXPECT_THAT(answer.error().message, HasSubstr("321 x 241"));
}

TEST(SvoAdapter, StartsAgainWhereUpstreamWouldStayPaused) {
  AdapterRun run("svo");
  run.track();
  run.track(standins::kDark);  // the two-view start fails, and upstream pauses
  EXPECT_EQ(run.track_plain(4).sample.state, TrackingState::kTracking);
  AdapterRun paused("svo", {{"restart_when_paused", false}});
  paused.track();
  paused.track(standins::kDark);
  EXPECT_EQ(paused.track_plain(4).sample.state, TrackingState::kInitialising);
}

/// What the adapter says to a camera of this size.
std::string svo_with_size(int width_px, int height_px, const VoParameters& parameters = {}) {
  auto started = start_adapter("svo", parameters);
  if (!started.ok()) return started.error().message;
  VoFrame frame = ordered_frame(0);
  frame.image = std::make_shared<const Image>(width_px, height_px, 1);
  frame.intrinsics =
      PinholeCamera::from_fov(width_px, height_px, 1.48, FovAxis::kHorizontal).value();
  const Result<VoEstimate> answer = started.value()->track(frame);
  return answer.ok() ? "taken" : answer.error().message;
}

TEST(SvoAdapter, RefusesAWidthThatDoesNotHalve) {
  EXPECT_THAT(svo_with_size(1242, 375),
              HasSubstr("frames of 1242 x 375 px: SVO halves them 4 times (nPyrLevels, "
                        "kltMaxLevel) and would write beyond an image of an odd width; take a "
                        "width that 16 divides"));
  EXPECT_EQ(svo_with_size(1232, 375), "taken") << "a row that is left over does no harm";
  EXPECT_EQ(svo_with_size(328, 240, {{"kltMaxLevel", 3.0}}), "taken");
  EXPECT_THAT(svo_with_size(328, 240), HasSubstr("take a width that 16 divides"));
}

TEST(SvoAdapter, WritesItsFileIntoTheTemporaryFolderOfItsRun) {
  const TemporaryFolder folder;
  const Environment temporary("TMPDIR", folder.path().string());
  const auto traces = [&] {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
      count += entry.path().filename() == "svo.csv" ? 1U : 0U;
    }
    return count;
  };
  {
    AdapterRun one("svo");
    AdapterRun other("svo");
    one.track();
    other.track();
    EXPECT_EQ(traces(), 2U);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SvoAdapter, RelocalisesInTheSameMap) {
  AdapterRun run("svo");
  run.track_plain(8);
  run.track(standins::kDark);
  const EstimateSample found = run.track().sample;
  EXPECT_EQ(found.state, TrackingState::kTracking);
  EXPECT_EQ(found.map_id, 0);
}

TEST(SvoAdapter, FiltersDepthsInStepWithTheFrames) {
  EXPECT_EQ(AdapterRun("svo").track().counters.at("features"), 120.0);
  EXPECT_EQ(AdapterRun("svo", {}, false).track().counters.at("features"), 119.0)
      << "one less with the thread, the stand-in says";
}

TEST(SvoAdapter, KnowsTheDefaultsOfTheRosNode) {
  AdapterRun run("svo", {{"preset", std::string("ros_fast")}});
  run.track();
  EXPECT_EQ(run.port().effective_parameters().at("gridSize"), "30");
  EXPECT_EQ(run.port().effective_parameters().at("maxNKfs"), "10");
}

}  // namespace
}  // namespace overfly::testing
