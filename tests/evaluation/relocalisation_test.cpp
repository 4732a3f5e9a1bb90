#include <gtest/gtest.h>

#include "tests/evaluation/flights.hpp"

namespace overfly::evaluation {
namespace {

/// A minute at 10 Hz with a perfect estimate, for tests to take away from.
class RelocalisationTest : public ::testing::Test {
 protected:
  void set(std::size_t from, std::size_t to, TrackingState state) {
    for (std::size_t i = from; i < to; ++i) track_.samples[i].state = state;
  }
  void set_map(std::size_t from, std::size_t to, int map_id) {
    for (std::size_t i = from; i < to; ++i) track_.samples[i].map_id = map_id;
  }
  /// The estimator never gets these frames.
  void take_away(int from, int to) {
    std::erase_if(track_.samples, [&](const EstimateSample& sample) {
      return sample.frame >= from && sample.frame < to;
    });
  }
  [[nodiscard]] Score scored() const {
    Options options;
    for (const StampedPose& pose : truth_.poses()) {
      options.flight.push_back({static_cast<std::int64_t>(options.flight.size()), pose.t_ns});
    }
    return score(truth_, track_, options);
  }
  void expect_none() const {
    const Score result = scored();
    EXPECT_EQ(result.relocalisations, 0);
    EXPECT_FALSE(result.relocalised_at_s.has_value());
  }
  void expect_one_at(double t_s) const {
    const Score result = scored();
    EXPECT_EQ(result.relocalisations, 1);
    ASSERT_TRUE(result.relocalised_at_s.has_value());
    EXPECT_DOUBLE_EQ(*result.relocalised_at_s, t_s);
  }

  Trajectory truth_ = wavy_truth(600);
  EstimateTrack track_ = seen_from(truth_, some_similarity());
};

TEST_F(RelocalisationTest, NoneWithoutALoss) { expect_none(); }

TEST_F(RelocalisationTest, NoneWhereNothingWasTracked) {
  set(0, 600, TrackingState::kInitialising);
  expect_none();
  track_.samples.clear();
  expect_none();
}

TEST_F(RelocalisationTest, OneAfterALossThatWasReported) {
  set(123, 151, TrackingState::kLost);
  expect_one_at(15.1);
  EXPECT_EQ(scored().outcome, Outcome::kCompleted) << "28 of 600 frames";
  set(123, 200, TrackingState::kLost);
  expect_one_at(20.0);
  EXPECT_EQ(scored().outcome, Outcome::kLost);
  EXPECT_DOUBLE_EQ(scored().outcome_time_s.value(), 12.3);
}

TEST_F(RelocalisationTest, OneAfterFramesThatWereMissing) {
  take_away(123, 151);
  expect_one_at(15.1);
}

TEST_F(RelocalisationTest, OneAfterALossOfWhichFramesWereMissing) {
  set(123, 130, TrackingState::kLost);
  set(140, 151, TrackingState::kInitialising);
  take_away(130, 140);
  expect_one_at(15.1);
}

TEST_F(RelocalisationTest, TwoAfterTwoLosses) {
  set(100, 120, TrackingState::kLost);
  take_away(300, 330);
  const Score result = scored();
  EXPECT_EQ(result.relocalisations, 2);
  EXPECT_DOUBLE_EQ(result.relocalised_at_s.value(), 12.0);
}

TEST_F(RelocalisationTest, NoneAfterAGapBelowASecond) {
  set(100, 109, TrackingState::kLost);  // from 9.9 s to 10.9 s
  expect_one_at(10.9);
  set(108, 109, TrackingState::kTracking);
  expect_none();
  take_away(200, 208);
  expect_none();
}

TEST_F(RelocalisationTest, NoneForFramesThatAreSecondsApart) {
  std::erase_if(track_.samples,
                [](const EstimateSample& sample) { return sample.frame % 20 != 0; });
  EXPECT_EQ(score(truth_, track_, {}).relocalisations, 0) << "every frame of the flight is tracked";
}

TEST_F(RelocalisationTest, NoneForALossThatLastsToTheEnd) {
  set(500, 600, TrackingState::kLost);
  expect_none();
  EXPECT_EQ(scored().outcome, Outcome::kLost);
  take_away(400, 600);
  expect_none();
}

TEST_F(RelocalisationTest, OneInTheLastFrame) {
  set(500, 599, TrackingState::kLost);
  expect_one_at(59.9);
}

TEST_F(RelocalisationTest, NothingCountsBeforeTheInitialisation) {
  set(0, 30, TrackingState::kLost);
  expect_none();
  take_away(0, 20);
  expect_none();
}

TEST_F(RelocalisationTest, ANewMapIsAResetInstead) {
  set(100, 150, TrackingState::kLost);
  set_map(130, 600, 1);
  expect_none();
  EXPECT_EQ(scored().reset_count, 1);
}

TEST_F(RelocalisationTest, AnEarlierMapThatIsFoundAfterALossCounts) {
  set(100, 150, TrackingState::kLost);
  set_map(150, 300, 1);
  set(280, 320, TrackingState::kLost);
  expect_one_at(32.0);
  // Without a loss before it, a return to an earlier map is no relocalisation.
  set(280, 320, TrackingState::kTracking);
  expect_none();
}

/// A fault of the camera's clock changes the stamps, not the flight.
TEST_F(RelocalisationTest, HasTheTimeOfTheFlightNotOfTheStamps) {
  set(123, 151, TrackingState::kLost);
  for (EstimateSample& sample : track_.samples) sample.t_ns -= 40'000'000;
  expect_one_at(15.1);
}

}  // namespace
}  // namespace overfly::evaluation
