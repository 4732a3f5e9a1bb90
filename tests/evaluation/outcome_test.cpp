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
  [[nodiscard]] Score scored() const { return score(truth_, track_, {}); }

  Trajectory truth_;
  EstimateTrack track_;
};

TEST_F(OutcomeTest, CompletedWhenItTracksAlmostAllAfterInitialisation) {
  set(0, 100, TrackingState::kInitialising);
  set(300, 325, TrackingState::kLost);  // 25 of 500: 95 % are tracked
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kCompleted);
  EXPECT_FALSE(result.outcome_time_s.has_value());
  EXPECT_EQ(result.frames, 600);
  EXPECT_EQ(result.tracked_frames, 475);
  EXPECT_DOUBLE_EQ(result.coverage, 475.0 / 600.0);
  EXPECT_DOUBLE_EQ(*result.initialised_at_s, 10.0);
  EXPECT_EQ(result.alignments.size(), 7U);
  EXPECT_TRUE(result.unavailable.empty());
}

TEST_F(OutcomeTest, NotInitialisedWhenItNeverTracks) {
  set(0, kFrames, TrackingState::kInitialising);
  const Score result = scored();
  EXPECT_EQ(result.outcome, Outcome::kNotInitialised);
  EXPECT_EQ(result.coverage, 0.0);
  EXPECT_FALSE(result.initialised_at_s.has_value());
  EXPECT_TRUE(result.alignments.empty());
  EXPECT_EQ(result.unavailable.size(), 7U);
  EXPECT_THAT(result.unavailable.at(AlignmentMode::kSim3), HasSubstr("never tracked"));
}

TEST_F(OutcomeTest, NothingAtAllIsNotInitialised) {
  track_.samples.clear();
  EXPECT_EQ(scored().outcome, Outcome::kNotInitialised);
  EXPECT_EQ(scored().frames, 0);
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
  // The second piece has an origin, rotation and scale of its own.
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

TEST_F(OutcomeTest, AChangeBelowTwoIsNoDivergence) {
  change_scale(&track_, 0.6);
  EXPECT_EQ(scored().outcome, Outcome::kCompleted);
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
  EXPECT_STREQ(to_string(Outcome::kLost), "LOST");
  EXPECT_STREQ(to_string(Outcome::kReset), "RESET");
  EXPECT_STREQ(to_string(Outcome::kDiverged), "DIVERGED");
  EXPECT_STREQ(to_string(Outcome::kCrashed), "CRASHED");
  EXPECT_STREQ(to_string(Outcome::kTimeout), "TIMEOUT");
}

}  // namespace
}  // namespace overfly::evaluation
