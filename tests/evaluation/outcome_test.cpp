#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

using ::testing::HasSubstr;

constexpr int kFrames = 600;  // a minute at 10 Hz

class OutcomeTest : public ::testing::Test {
 protected:
  OutcomeTest() : truth_(wavy_truth(kFrames)), track_(seen_from(truth_, some_similarity())) {}

  void set(int from, int to, TrackingState state) {
    for (int i = from; i < to; ++i) track_.samples[static_cast<std::size_t>(i)].state = state;
  }
  void set_map(int from, int map_id) {
    for (int i = from; i < kFrames; ++i)
      track_.samples[static_cast<std::size_t>(i)].map_id = map_id;
  }
  /// A fault of the camera's clock.
  void shift_stamps(std::int64_t offset_ns) {
    for (EstimateSample& sample : track_.samples) sample.t_ns += offset_ns;
  }
  /// The estimator never gets these frames; the flight still has them.
  void take_away(int from, int to) {
    std::erase_if(track_.samples, [&](const EstimateSample& sample) {
      return sample.frame >= from && sample.frame < to;
    });
  }
  [[nodiscard]] Score scored() const {
    Options options;
    for (int i = 0; i < kFrames; ++i) options.flight.push_back({i, i * kFrameNs});
    return score(truth_, track_, options);
  }

  Trajectory truth_;
  EstimateTrack track_;
};

TEST_F(OutcomeTest, CompletedWhenItTracksAlmostAllAfterInitialisation) {
  set(0, 40, TrackingState::kInitialising);
  set(300, 328, TrackingState::kLost);  // 28 of 560: 95 % are tracked
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kCompleted);
  EXPECT_FALSE(result.outcome_time_s.has_value());
  EXPECT_EQ(result.frames, 600);
  EXPECT_EQ(result.tracked_frames, 532);
  EXPECT_DOUBLE_EQ(result.coverage, 532.0 / 600.0);
  EXPECT_DOUBLE_EQ(*result.initialised_at_s, 4.0);
  EXPECT_EQ(result.alignments.size(), 8U);
  EXPECT_TRUE(result.unavailable.empty());
}

TEST_F(OutcomeTest, NotInitialisedWhenItNeverTracks) {
  set(0, kFrames, TrackingState::kInitialising);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kNotInitialised);
  EXPECT_EQ(result.coverage, 0.0);
  EXPECT_FALSE(result.initialised_at_s.has_value());
  EXPECT_TRUE(result.alignments.empty());
  EXPECT_EQ(result.unavailable.size(), 8U);
  EXPECT_THAT(result.unavailable.at(AlignmentMode::kSim3), HasSubstr("never tracked"));
}

TEST_F(OutcomeTest, NothingAtAllIsNotInitialised) {
  track_.samples.clear();
  EXPECT_EQ(scored().outcome, Outcome::kNotInitialised);
  EXPECT_EQ(scored().frames, kFrames);
  EXPECT_EQ(score(truth_, track_, {}).frames, 0);
}

TEST_F(OutcomeTest, AStartAfterATenthOfTheFlightIsLate) {
  set(0, 59, TrackingState::kInitialising);  // a tenth of 59.9 s: 5.99 s
  EXPECT_EQ(scored().outcome, Outcome::kCompleted);
  set(59, 60, TrackingState::kInitialising);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kInitLate);
  EXPECT_DOUBLE_EQ(*result.outcome_time_s, 6.0);
  EXPECT_DOUBLE_EQ(result.coverage, 0.9);
}

TEST_F(OutcomeTest, HasTheDistanceFlownUntilItsTime) {
  set(400, kFrames, TrackingState::kLost);
  const Score result = scored();
  ASSERT_EQ(result.outcome, Outcome::kLost);
  ASSERT_DOUBLE_EQ(*result.outcome_time_s, 40.0);
  double flown_m = 0.0;
  for (std::size_t i = 1; i <= 400; ++i) {
    const auto& poses = truth_.poses();
    flown_m += (poses[i].pose.translation - poses[i - 1].pose.translation).norm();
  }
  EXPECT_GT(flown_m, 0.5 * truth_.path_length_m());
  EXPECT_NEAR(result.outcome_distance_m.value(), flown_m, 1e-9);
  EXPECT_FALSE(score({}, track_, {}).outcome_distance_m.has_value());
}

TEST_F(OutcomeTest, AStartIsLateWhetherFramesBeforeItWereGivenOrNot) {
  take_away(0, 60);
  EXPECT_EQ(scored().outcome, Outcome::kInitLate);
  EXPECT_DOUBLE_EQ(*scored().outcome_time_s, 6.0);
}

/// Outcome of a perfect track of a flight at 10 Hz that begins with its frame `first`.
Outcome outcome_from(int first, int frames) {
  const Trajectory truth = wavy_truth(frames);
  EstimateTrack track = seen_from(truth, some_similarity());
  for (int i = 0; i < first; ++i) {
    track.samples[static_cast<std::size_t>(i)].state = TrackingState::kInitialising;
  }
  return score(truth, track, {}).outcome;
}

TEST(Outcome, AStartAfterTenSecondsIsLateHoweverLongTheFlight) {
  EXPECT_EQ(outcome_from(100, 3000), Outcome::kCompleted);
  EXPECT_EQ(outcome_from(101, 3000), Outcome::kInitLate);
}

TEST(Outcome, AStartWithinTwoSecondsIsNeverLate) {
  EXPECT_EQ(outcome_from(20, 30), Outcome::kCompleted);
  EXPECT_EQ(outcome_from(21, 30), Outcome::kInitLate);
}

TEST_F(OutcomeTest, ALossIsToldBeforeALateStart) {
  set(0, 100, TrackingState::kInitialising);
  set(500, kFrames, TrackingState::kLost);
  EXPECT_EQ(scored().outcome, Outcome::kLost);
}

TEST_F(OutcomeTest, DarknessAndMissingFramesAreJudgedAlike) {
  // 5 % of the 600 frames are 30: 3 s.
  for (const int frames : {30, 31}) {
    const EstimateTrack kept = track_;
    set(200, 200 + frames, TrackingState::kLost);
    const Score dark = scored();
    track_ = kept;
    take_away(200, 200 + frames);
    const Score missing = scored();
    track_ = kept;
    EXPECT_EQ(dark.outcome, frames == 30 ? Outcome::kCompleted : Outcome::kLost) << frames;
    EXPECT_EQ(missing.outcome, dark.outcome) << frames;
    EXPECT_EQ(missing.outcome_time_s, dark.outcome_time_s) << frames;
    EXPECT_EQ(missing.coverage, dark.coverage) << frames;
    EXPECT_EQ(missing.frames, kFrames) << frames;
    EXPECT_EQ(missing.alignments.at(AlignmentMode::kSim3).position_rmse_hold_m,
              dark.alignments.at(AlignmentMode::kSim3).position_rmse_hold_m)
        << frames;
  }
}

TEST_F(OutcomeTest, ABusyEstimatorIsNotLostButCoversLess) {
  for (int i = 1; i < kFrames; i += 2) take_away(i, i + 1);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kCompleted);
  EXPECT_EQ(result.tracked_frames, 300);
  EXPECT_DOUBLE_EQ(result.coverage, 0.5);
}

TEST_F(OutcomeTest, AnEstimatorThatHangsIsLostWhereItHung) {
  take_away(190, kFrames);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kLost);
  EXPECT_DOUBLE_EQ(*result.outcome_time_s, 19.0);
  EXPECT_DOUBLE_EQ(result.coverage, 190.0 / 600.0);
}

TEST_F(OutcomeTest, AClockThatIsSlowDoesNotMakeAShortGapALoss) {
  shift_stamps(-kNsPerS);
  take_away(599, kFrames);
  EXPECT_EQ(scored().outcome, Outcome::kCompleted);
  EXPECT_EQ(scored().initialised_at_s, 0.0);
}

TEST_F(OutcomeTest, AClockThatIsFastDoesNotHideALoss) {
  shift_stamps(1'500'000'000);
  take_away(585, kFrames);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kLost);
  EXPECT_DOUBLE_EQ(*result.outcome_time_s, 58.5);
}

TEST_F(OutcomeTest, AClockThatIsFastDoesNotMakeAStartLate) {
  shift_stamps(6 * kNsPerS);
  take_away(0, 1);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kCompleted);
  EXPECT_DOUBLE_EQ(*result.initialised_at_s, 0.1);
}

TEST_F(OutcomeTest, FramesMissedByOneThatWasLostAreNoTrackedOnes) {
  set(290, 300, TrackingState::kLost);
  set(305, 325, TrackingState::kLost);  // without others, 95 % are tracked
  EXPECT_EQ(scored().outcome, Outcome::kCompleted);
  take_away(300, 305);
  EXPECT_EQ(scored().outcome, Outcome::kLost);
}

TEST_F(OutcomeTest, LostAtTheBeginOfTheLossThatLasts) {
  set(100, 120, TrackingState::kLost);
  set(400, kFrames, TrackingState::kLost);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kLost);
  EXPECT_DOUBLE_EQ(*result.outcome_time_s, 40.0);
}

TEST_F(OutcomeTest, LostWhenTooMuchIsMissingThoughItTracksAtTheEnd) {
  set(200, 231, TrackingState::kLost);  // 31 of 600: 94.8 % are tracked
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kLost);
  EXPECT_DOUBLE_EQ(*result.outcome_time_s, 20.0);
}

TEST_F(OutcomeTest, ResetScoresThePieceWithTheMostFramesAndSaysSo) {
  set(200, 220, TrackingState::kInitialising);
  set_map(200, 1);
  // The second piece has its own origin, rotation and scale.
  const Similarity other{0.5, Eigen::Quaterniond(0.9, 0.1, 0.4, 0.1).normalized(), {1, 2, 3}};
  for (std::size_t i = 200; i < track_.samples.size(); ++i) {
    track_.samples[i].T_vo_camera = other * track_.samples[i].T_vo_camera;
  }
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kReset);
  EXPECT_EQ(result.reset_count, 1);
  EXPECT_DOUBLE_EQ(*result.outcome_time_s, 20.0);
  const AlignmentScore& sim3 = result.alignments.at(AlignmentMode::kSim3);
  EXPECT_EQ(sim3.matched, 380);
  EXPECT_LT(sim3.position_m.max, 1e-6);
  ASSERT_FALSE(sim3.notes.empty());
  EXPECT_THAT(sim3.notes[0], HasSubstr("380 of 580 tracked frames"));
}

TEST_F(OutcomeTest, AResetThatNeverTracksAgainIsALoss) {
  set(200, kFrames, TrackingState::kInitialising);
  set_map(250, 1);
  set_map(400, 2);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kLost);
  EXPECT_DOUBLE_EQ(*result.outcome_time_s, 20.0);
  EXPECT_EQ(result.reset_count, 2);
}

TEST_F(OutcomeTest, AMapThatIsFoundAgainIsNoReset) {
  set_map(0, 5);
  set_map(200, 3);
  set_map(300, 5);
  set_map(400, 3);
  set_map(500, 100);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kReset);
  EXPECT_EQ(result.reset_count, 2) << "maps 3 and 100";
  EXPECT_DOUBLE_EQ(*result.outcome_time_s, 20.0);
}

/// From 30 s on the scale shrinks by a factor at once; jumps of position do not occur.
void change_scale(EstimateTrack* track, double factor) {
  const Eigen::Vector3d hinge = track->samples[300].T_vo_camera.translation;
  for (std::size_t i = 300; i < track->samples.size(); ++i) {
    Eigen::Vector3d& p = track->samples[i].T_vo_camera.translation;
    p = hinge + factor * (p - hinge);
  }
}

TEST_F(OutcomeTest, DivergedWhenTheScaleChangesByMoreThanTwo) {
  for (const double factor : {0.4, 2.5}) {
    EstimateTrack kept = track_;
    change_scale(&track_, factor);
    const Score result = scored();
    EXPECT_EQ(result.outcome, Outcome::kDiverged) << factor;
    // Seen within one window of 10 s.
    EXPECT_GT(*result.outcome_time_s, 30.0);
    EXPECT_LE(*result.outcome_time_s, 40.0);
    EXPECT_EQ(result.coverage, 1.0);
    track_ = kept;
  }
}

TEST_F(OutcomeTest, AFastClockDoesNotDelayADivergence) {
  change_scale(&track_, 2.5);
  const double time_s = scored().outcome_time_s.value();
  shift_stamps(6 * kNsPerS);
  const Score result = scored();
  ASSERT_EQ(result.outcome, Outcome::kDiverged);
  // Scales are those of the truth at the stamps, in steps of one second.
  EXPECT_NEAR(result.outcome_time_s.value(), time_s, 1.0);
}

TEST_F(OutcomeTest, AChangeBelowTwoIsNoDivergence) {
  change_scale(&track_, 0.6);
  EXPECT_EQ(scored().outcome, Outcome::kCompleted);
}

TEST_F(OutcomeTest, TheChangeOfScaleIsThatOfItsWindows) {
  const auto change = [&] { return scale_change(associate(truth_, track_, {}).value()).value(); };
  EXPECT_NEAR(change(), 1.0, 1e-6);
  change_scale(&track_, 0.6);
  EXPECT_NEAR(change(), 1.0 / 0.6, 1e-3);
  set(90, kFrames, TrackingState::kLost);
  EXPECT_FALSE(scale_change(associate(truth_, track_, {}).value()).has_value()) << "below 10 s";
}

TEST_F(OutcomeTest, DivergedWhenItStandsStillAndClaimsToTrack) {
  change_scale(&track_, 0.0);
  EXPECT_EQ(scored().outcome, Outcome::kDiverged);
}

TEST_F(OutcomeTest, DivergenceIsToldBeforeALoss) {
  change_scale(&track_, 0.3);
  set(500, kFrames, TrackingState::kLost);
  EXPECT_EQ(scored().outcome, Outcome::kDiverged);
}

TEST_F(OutcomeTest, JitterFromFrameToFrameIsNoDivergence) {
  // From 30 s on every second pose is 2 m to the side: at 2.5 m a frame this doubles the way.
  for (std::size_t i = 300; i < track_.samples.size(); i += 2) {
    track_.samples[i].T_vo_camera.translation.x() += 4.0 / some_similarity().scale;
  }
  EXPECT_EQ(scored().outcome, Outcome::kCompleted);
}

TEST_F(OutcomeTest, AGapInTrackingIsNoDivergence) {
  set(200, 222, TrackingState::kLost);
  EXPECT_EQ(scored().outcome, Outcome::kCompleted);
}

TEST_F(OutcomeTest, FramesWithoutTruthAreCounted) {
  track_.samples.back().t_ns += kNsPerS;
  const AlignmentScore none = scored().alignments.at(AlignmentMode::kNone);
  ASSERT_EQ(none.notes.size(), 1U);
  EXPECT_THAT(none.notes[0], HasSubstr("1 tracked frames have no truth"));
}

TEST_F(OutcomeTest, TracksWithoutOverlapHaveAnOutcomeAndReasons) {
  for (EstimateSample& sample : track_.samples) sample.t_ns += 1000 * kNsPerS;
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kCompleted);
  EXPECT_THAT(result.unavailable.at(AlignmentMode::kNone), HasSubstr("no pose of the estimate"));
}

TEST(Outcome, HasTheNamesOfTheConventions) {
  EXPECT_STREQ(to_string(Outcome::kCompleted), "COMPLETED");
  EXPECT_STREQ(to_string(Outcome::kNotInitialised), "NOT_INITIALISED");
  EXPECT_STREQ(to_string(Outcome::kInitLate), "INIT_LATE");
  EXPECT_STREQ(to_string(Outcome::kLost), "LOST");
  EXPECT_STREQ(to_string(Outcome::kReset), "RESET");
  EXPECT_STREQ(to_string(Outcome::kDiverged), "DIVERGED");
  EXPECT_STREQ(to_string(Outcome::kCrashed), "CRASHED");
  EXPECT_STREQ(to_string(Outcome::kTimeout), "TIMEOUT");
}

TEST_F(OutcomeTest, FramesMissingAtTheEndAreALossFromOneSecondOn) {
  take_away(591, kFrames);  // 0.9 s after the last answer
  EXPECT_EQ(scored().outcome, Outcome::kCompleted);
  take_away(585, kFrames);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kLost);
  ASSERT_TRUE(result.outcome_time_s.has_value());
  EXPECT_DOUBLE_EQ(*result.outcome_time_s, 58.5);
}

}  // namespace
}  // namespace overfly::evaluation
